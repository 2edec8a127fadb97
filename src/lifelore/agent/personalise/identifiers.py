"""Identifiers of decisions: UUIDs in the order of their times, and their text."""

import hashlib
import os
import re
import threading
import uuid
from collections.abc import Sequence

import numpy as np

from lifelore.core.errors import InputError

EARLIER_IDENTIFIER = re.compile(r"[0-9a-f]{16}(-\d{1,9}(\.\d{1,9})?|\.\d+/\d+)")
"""Of a decision that an earlier Lifelore stored."""
_DIGITS = np.delete(np.arange(36), [8, 13, 18, 23])
"""Places of the digits in the text of a UUID."""
SET_BACK = 60_000
"""Milliseconds by which a clock may run back without an effect on the order of identifiers."""


class _Clock:
    """Times of identifiers: milliseconds, and a number that rises within one.

    In a process they only rise, unless the machine's clock is set back by more than `SET_BACK`.
    """

    def __init__(self) -> None:
        self._lock, self._ticks = threading.Lock(), 0

    def tick(self, now: int) -> int:
        """Milliseconds since 1970 · 2¹² + number."""
        with self._lock:
            following = self._ticks + 1 if now << 12 > self._ticks - (SET_BACK << 12) else 0
            self._ticks = max(now << 12, following)
            return self._ticks


_CLOCK = _Clock()


def new_ids(now: int, n: int) -> list[bytes]:
    """Version 7 UUIDs of a time in milliseconds: those of a process are in the order in which they were made."""
    milliseconds, number = divmod(_CLOCK.tick(now), 1 << 12)
    head = (milliseconds << 16 | 0x7000 | number).to_bytes(8, "big")
    drawn = np.frombuffer(os.urandom(8 * n), ">u8") >> np.uint64(2) | np.uint64(1 << 63)
    tails = np.sort(drawn).astype(">u8").tobytes()
    return [head + tails[at : at + 8] for at in range(0, 8 * n, 8)]


def identifier(id_: bytes) -> str:
    """The text by which an outcome is given later."""
    text = id_.hex()
    return f"{text[:8]}-{text[8:12]}-{text[12:16]}-{text[16:20]}-{text[20:]}"


def identifiers(ids: Sequence[bytes]) -> list[str]:
    """The `identifier` of each of many."""
    text = np.full((len(ids), 36), ord("-"), np.uint8)
    text[:, _DIGITS] = np.frombuffer(b"".join(ids).hex().encode(), np.uint8).reshape(-1, 32)
    whole = text.tobytes().decode()
    return [whole[at : at + 36] for at in range(0, len(whole), 36)]


def parse_identifier(text: str) -> bytes:
    """The 16 bytes of a decision's identifier, also of one of an earlier Lifelore; InputError where it is none."""
    try:
        if len(text) == 36:
            return bytes.fromhex(text.replace("-", ""))
        if EARLIER_IDENTIFIER.fullmatch(text):
            return bytes(6) + hashlib.sha256(text.encode()).digest()[:10]
        return uuid.UUID(text).bytes
    except (ValueError, AttributeError, TypeError):
        raise InputError(f"decision must be the identifier that a choice gave, got {str(text)[:60]!r}") from None
