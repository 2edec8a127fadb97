"""Policies of a library: tables of values learnt here, or functions of the observation by the user's learner."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from lifelore.core.protocols import Record
from lifelore.memory.byte_words import bytes_of, words_of


@dataclass(eq=False)
class QTable:
    """Values of actions in the states that were met; the policy takes the best action.

    Parameters
    ----------
    values : dict of int to (n_actions,) float64
        By the code of the state.
    """

    values: dict[int, NDArray[np.float64]] = field(default_factory=dict)

    def to_records(self, kind: str, key: str, before: "QTable | None" = None) -> Iterator[Record]:
        """The values that differ from those of `before`, as a record of which the newest value wins."""
        old = {} if before is None else before.values
        new = {
            state: row
            for state, row in sorted(self.values.items())
            if state not in old or not np.array_equal(old[state], row)
        }
        if new:
            rows = np.array(list(new.values()), np.float64)
            codes = np.array(list(new), np.int64)[:, None] * rows.shape[1] + np.arange(rows.shape[1])
            yield Record(kind, key, 1, "newest", codes.ravel(), rows.view(np.int64).ravel())

    def update(self, record: Record, n_actions: int) -> None:
        """Take the values of a record of `to_records`."""
        for code, value in zip(record.slots.tolist(), record.values.view(np.float64).tolist(), strict=True):
            state, action = divmod(code, n_actions)
            self.values.setdefault(state, np.zeros(n_actions))[action] = value


@runtime_checkable
class StoresItself(Protocol):
    """A policy of the user's learner that memory can keep; the learner's ``from_bytes`` makes it again."""

    def __call__(self, observation: Any) -> int:
        """The action for an observation."""
        ...

    def to_bytes(self) -> bytes:
        """All that makes the policy again."""
        ...


@dataclass(frozen=True)
class StoredPolicy:
    """A policy of the user's learner as memory holds it."""

    content: bytes

    @classmethod
    def from_record(cls, record: Record) -> "StoredPolicy":
        """The policy in a record of `stored`."""
        return cls(bytes_of(record.values[1:], int(record.values[0])))


def stored(policy: StoresItself, kind: str, key: str) -> Record:
    """A policy of the user's learner as a record; a shorter one leaves old words behind, which do not count."""
    content = policy.to_bytes()
    words = np.concatenate([[len(content)], words_of(content)]).astype(np.int64)
    return Record(kind, key, 1, "newest", np.arange(len(words)), words)
