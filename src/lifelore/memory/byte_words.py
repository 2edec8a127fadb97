"""Bytes as the values of a record: eight a value, the last padded with zeros; their number is kept elsewhere."""

import numpy as np
from numpy.typing import NDArray


def words_of(content: bytes) -> NDArray[np.int64]:
    """The values for some bytes, (⌈n / 8⌉,)."""
    return np.frombuffer(content + bytes(-len(content) % 8), "<i8").astype(np.int64)


def bytes_of(words: NDArray[np.int64], size: int) -> bytes:
    """The first `size` bytes of `words_of`; values behind them, such as those of longer content, do not count."""
    return words[: -(-size // 8)].astype("<i8").tobytes()[:size]
