"""Moves of tasks without tables: what followed on an action in a state, as integer codes equal in every process.

A move has two causes. That of the next state is the state and the action; that of the reward, and of whether the
episode ended, is all three. Where moves are noisy, rewards mostly are not: they tell types apart by themselves.
"""

import hashlib
from collections.abc import Hashable, Iterator

import numpy as np

from lifelore.agent.external_world.context_code import ContextCodes
from lifelore.agent.external_world.episode import Step
from lifelore.core.protocols import Record

OUTCOME_BITS = 16
"""Bits of an outcome's code: of ten outcomes of a cause two share a code in 0.07 % of causes."""
CAUSE_BITS = 47
"""Bits of a cause's code."""
MOST_REPEATS = 20
"""Most times that a task counts one cause: in a task the same cause is mostly answered alike."""
ONE = 1_000_000
"""Fixed-point unit of counts in records."""


Pairs = tuple[tuple[int, int], tuple[int, int]]
"""Cause and outcome of where a move led, and of what it paid. The last bit of a cause's code says which it is."""


class MoveCodes:
    """Codes of causes and outcomes, kept once they are made."""

    def __init__(self) -> None:
        self.states = ContextCodes()
        self._causes: dict[tuple[int, int], int] = {}
        self._pairs: dict[tuple[int, int, int, float, bool], Pairs] = {}

    def state(self, state: Hashable) -> int:
        """The code of a state; InputError for a state without a stable code."""
        return self.states[state]

    def cause(self, state: int, action: int) -> int:
        """The code of the cause of the next state."""
        pair = state, action
        code = self._causes.get(pair)
        if code is None:
            code = self._causes[pair] = _hashed(f"{state} {action}", CAUSE_BITS - 1) << 1
        return code

    def pairs(self, step: Step) -> Pairs:
        """Codes of the causes of a move and of their outcomes; rewards count to six digits."""
        move = step.state, step.action, step.following, round(step.reward, 6), step.ended
        found = self._pairs.get(move)
        if found is None:
            paid = _hashed(f"{step.state} {step.action} {step.following}", CAUSE_BITS - 1) << 1 | 1
            pay = _hashed(f"{move[3]:.6f} {step.ended}", OUTCOME_BITS)
            arrived = _hashed(f"{step.following}", OUTCOME_BITS)
            found = self._pairs[move] = ((self.cause(step.state, step.action), arrived), (paid, pay))
        return found


class OutcomeCounts:
    """Counts of outcomes by cause, of one type; they add up, so robots can share them."""

    def __init__(self) -> None:
        self.by_cause: dict[int, dict[int, float]] = {}

    def add(self, cause: int, outcome: int, weight: float = 1.0) -> None:
        """Count an outcome."""
        row = self.by_cause.setdefault(cause, {})
        row[outcome] = row.get(outcome, 0.0) + weight

    def total(self, cause: int) -> float:
        """Number of outcomes of a cause."""
        return sum(self.by_cause.get(cause, {}).values())

    def merge(self, other: "OutcomeCounts") -> None:
        """Add all counts of another."""
        for cause, outcome, count in other.items():
            self.add(cause, outcome, count)

    def items(self) -> Iterator[tuple[int, int, float]]:
        """(cause, outcome, count) of each counted outcome."""
        for cause, row in self.by_cause.items():
            for outcome, count in row.items():
                yield cause, outcome, count

    def scaled(self, weight: float) -> "OutcomeCounts":
        """The counts times a weight."""
        scaled = OutcomeCounts()
        for cause, outcome, count in self.items():
            scaled.add(cause, outcome, weight * count)
        return scaled

    def to_record(self, kind: str, key: str) -> Record:
        """The counts as a record that memory adds."""
        cells = [(cause << OUTCOME_BITS | outcome, round(count * ONE)) for cause, outcome, count in self.items()]
        slots, values = np.array(sorted(cells), np.int64).reshape(-1, 2).T
        return Record(kind, key, 1, "add", slots.copy(), values.copy())

    @classmethod
    def from_record(cls, record: Record) -> "OutcomeCounts":
        """The counts of a record."""
        counts = cls()
        for slot, value in zip(record.slots.tolist(), record.values.tolist(), strict=True):
            counts.add(slot >> OUTCOME_BITS, slot & (1 << OUTCOME_BITS) - 1, value / ONE)
        return counts


def counted(steps: list[Step], codes: MoveCodes) -> OutcomeCounts:
    """Counts of the outcomes of a task's steps; a cause counts `MOST_REPEATS` times at most."""
    counts = OutcomeCounts()
    for step in steps:
        for cause, outcome in codes.pairs(step):
            counts.add(cause, outcome)
    for row in counts.by_cause.values():
        share = min(1.0, MOST_REPEATS / sum(row.values()))
        for outcome in row:
            row[outcome] *= share
    return counts


def _hashed(text: str, bits: int) -> int:
    return int.from_bytes(hashlib.blake2b(text.encode(), digest_size=8).digest(), "big") >> (64 - bits)
