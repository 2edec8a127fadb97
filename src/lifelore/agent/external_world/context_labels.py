"""Stores the features behind context codes in a memory as text, and reads them when a table shows them.

A record holds a context in up to 16 slots: code · 16 + place. The first value is the number of bytes of the text,
the others are its bytes, eight a value. Each contribution writes a context completely and the newest wins, so that
texts never mix, also after robots' memories were merged.
"""

import ast
from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.protocols import Record
from lifelore.memory.byte_words import bytes_of, words_of

KIND, VERSION = "context_labels", 1
SLOTS = 16
"""Slots of a context."""
MOST_BYTES = 8 * (SLOTS - 1)
"""Bytes of a stored text; longer texts are cut. More need more memory: eight bytes a value and some 30 beside."""


def labels_record(key: str, contexts: Mapping[int, Hashable]) -> Record:
    """The record of the features of some contexts; codes must lie in [0, 2**59)."""
    slots: list[NDArray[np.int64]] = []
    values: list[NDArray[np.int64]] = []
    for code, context in contexts.items():
        text = repr(_plain(context)).encode("utf-8", "replace")[:MOST_BYTES]
        own = np.concatenate([[len(text)], words_of(text)])
        slots.append(code * SLOTS + np.arange(len(own)))
        values.append(own)
    empty = np.empty(0, np.int64)
    return Record(KIND, key, VERSION, "newest", np.concatenate([empty, *slots]), np.concatenate([empty, *values]))


def _plain(part: Any) -> Any:
    """NumPy's numbers as Python's, also within tuples."""
    if isinstance(part, np.generic):
        return part.item()
    return tuple(map(_plain, part)) if type(part) is tuple else part


class ContextLabels(Mapping[int, Any]):
    """Context code to the features in a record of `labels_record`.

    The record is read when the first label is asked for, and a text decoded when it is asked for.

    Features that Python can read again (tuples of numbers and text) are values as in the life; others, and those
    that were cut, are text.

    Parameters
    ----------
    read : callable
        Gives the record, or None where there are no labels.

    Examples
    --------
    >>> labels = ContextLabels(lambda: labels_record("k", {7: ("free", 1, np.int64(3)), 9: None}))
    >>> labels[7], list(labels), labels.get(8, "unknown")
    (('free', 1, 3), [7, 9], 'unknown')
    """

    def __init__(self, read: Callable[[], Record | None]) -> None:
        self._read = read

    def __getstate__(self) -> dict[str, Any]:
        """A pickle holds the record itself, and neither the memory's place nor its password."""
        return {"_record": self._record}

    @cached_property
    def _record(self) -> Record:
        """The record, by rising slots."""
        record = self._read() or labels_record("", {})
        if (record.kind, record.version) != (KIND, VERSION):
            raise InputError(f"record must be {KIND} version {VERSION}, got {record.kind} {record.version}")
        order = np.argsort(record.slots)
        return replace(record, slots=record.slots[order], values=record.values[order])

    @cached_property
    def _starts(self) -> NDArray[np.int64]:
        """The first place of each context in the record."""
        return np.flatnonzero(self._record.slots % SLOTS == 0)

    @cached_property
    def _codes(self) -> NDArray[np.int64]:
        return self._record.slots[self._starts] // SLOTS

    def __len__(self) -> int:
        return len(self._codes)

    def __iter__(self) -> Iterator[int]:
        return iter(self._codes.tolist())

    def __getitem__(self, code: int) -> Any:
        place = int(np.searchsorted(self._codes, code))
        if place == len(self) or self._codes[place] != code:
            raise KeyError(code)
        start = self._starts[place]
        values = self._record.values
        size = int(values[start])
        text = bytes_of(values[start + 1 : start + SLOTS], size).decode("utf-8", "ignore")
        try:
            return ast.literal_eval(text)
        except (ValueError, SyntaxError, TypeError, MemoryError, RecursionError):
            return text
