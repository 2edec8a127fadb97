"""Policies of a library: tables of values learnt here, or functions of the observation by the user's learner."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.protocols import Record
from lifelore.memory.byte_words import bytes_of, words_of

QTable = dict[int, NDArray[np.float64]]
"""Values of actions (n_actions,) by the code of each state that was met; the policy takes the best action."""


def table_records(table: QTable, kind: str, key: str, before: QTable) -> Iterator[Record]:
    """The values that differ from those before, as a record of which the newest value wins."""
    new = {
        state: row
        for state, row in sorted(table.items())
        if state not in before or not np.array_equal(before[state], row)
    }
    if new:
        rows = np.array(list(new.values()), np.float64)
        codes = np.array(list(new), np.int64)[:, None] * rows.shape[1] + np.arange(rows.shape[1])
        yield Record(kind, key, 1, "newest", codes.ravel(), rows.view(np.int64).ravel())


def update_table(table: QTable, record: Record, n_actions: int) -> None:
    """Take the values of a record of `table_records`."""
    for code, value in zip(record.slots.tolist(), record.values.view(np.float64).tolist(), strict=True):
        state, action = divmod(code, n_actions)
        table.setdefault(state, np.zeros(n_actions))[action] = value


@dataclass(frozen=True)
class StoredPolicy:
    """A policy of the user's learner as memory holds it."""

    content: bytes

    @classmethod
    def from_record(cls, record: Record) -> "StoredPolicy":
        """The policy in a record of `stored`."""
        return cls(bytes_of(record.values[1:], int(record.values[0])))


def stored(content: bytes, kind: str, key: str) -> Record:
    """A policy of the user's learner as a record; a shorter one leaves old words behind, which do not count."""
    words = np.concatenate([[len(content)], words_of(content)]).astype(np.int64)
    return Record(kind, key, 1, "newest", np.arange(len(words)), words)
