"""Moves of tasks without tables: what followed on an action in a state, as integer codes equal in every process.

A move has two causes. That of the next state is the state and the action; that of the reward, and of whether the
episode ended, is all three. Where moves are noisy, rewards mostly are not: they tell types apart by themselves.
"""

import hashlib
from collections import Counter

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


Counts = Counter[tuple[int, int]]
"""Number of times of each pair, such as a cause and its outcome; counts add up, so robots can share them."""


def totals(counts: Counts) -> Counter[int]:
    """Number of outcomes of each cause."""
    found = Counter[int]()
    for (cause, _), count in counts.items():
        found[cause] += count
    return found


def counts_record(kind: str, key: str, counts: Counts, weight: float = 1.0, bits: int = OUTCOME_BITS) -> Record:
    """Counts times a weight as a record that memory adds; the second number of a pair has so many bits."""
    cells = sorted((one << bits | two, round(weight * count * ONE)) for (one, two), count in counts.items())
    slots, values = np.array(cells, np.int64).reshape(-1, 2).T
    return Record(kind, key, 1, "add", slots.copy(), values.copy())


def counts_of(record: Record, bits: int = OUTCOME_BITS) -> Counts:
    """The counts in a record of `counts_record`."""
    pairs = (divmod(slot, 1 << bits) for slot in record.slots.tolist())
    return Counter(dict(zip(pairs, (record.values / ONE).tolist(), strict=True)))


def counted(steps: list[Step], codes: MoveCodes) -> Counts:
    """Counts of the outcomes of a task's steps; a cause counts `MOST_REPEATS` times at most."""
    counts = Counter(pair for step in steps for pair in codes.pairs(step))
    most = totals(counts)
    return Counter({pair: count * min(1.0, MOST_REPEATS / most[pair[0]]) for pair, count in counts.items()})


def _hashed(text: str, bits: int) -> int:
    return int.from_bytes(hashlib.blake2b(text.encode(), digest_size=8).digest(), "big") >> (64 - bits)
