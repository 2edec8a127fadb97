"""Whether the tasks of a life differ in anything that was observed: next states, ends of episodes, rewards.

A life whose tasks are all one decision process measures repetition, not transfer. The transitions of each task are
compared with those of the tasks before it, in the pairs of state and action that both have:

- If the same pair always had one outcome within a task, one pair with two outcomes tells the tasks apart.
- Otherwise outcomes are uncertain, and a permutation test of homogeneity decides: the outcomes of a pair are dealt
  anew between the task and its predecessors, with their numbers fixed. Small counts are no problem for it.
"""

from collections import Counter, defaultdict
from collections.abc import Hashable

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream

MOST_STEPS = 5000
"""Transitions of a task that are compared; more cost memory (some 200 bytes each) and tell finer differences."""
LEAST_SHARED = 100
"""Transitions in pairs that earlier tasks have, below which tasks are not called one."""
LEAST_SHARE = 0.5
"""Share of a task's transitions in such pairs below which the task is another one: it lies in other states."""
DEALS = 199
"""Permutations of a test; with 199 the smallest p-value is 0.005."""
CERTAIN = 0.01
"""p-value below which two tasks differ; more calls equal tasks different more often, and then nothing warns."""

Pair = tuple[Hashable, int]


class TaskDifferences:
    """Compares tasks while a life runs; after the first difference it records nothing more."""

    def __init__(self) -> None:
        self.tasks = self.shared = 0
        self.differ = False
        self._moves, self._rewards = _Outcomes(), _Outcomes()
        self._steps = 0

    def see(self, state: Hashable, action: int, following: Hashable, reward: float, terminated: bool) -> None:
        """Record a transition of the current task."""
        if not self.differ and self._steps < MOST_STEPS:
            self._steps += 1
            self._moves.add((state, action), (following, terminated))
            self._rewards.add((state, action), reward)

    def end_task(self) -> None:
        """Compare the current task with those before it."""
        self.tasks += 1
        if self.tasks > 1 and not self.differ:
            shared = self._moves.shared()
            self.shared += shared
            elsewhere = shared < LEAST_SHARE * self._steps
            self.differ = elsewhere or self._moves.differ() or self._rewards.differ()
        for outcomes in (self._moves, self._rewards):
            outcomes.end_task(keep=not self.differ)
        self._steps = 0

    @property
    def one_task(self) -> bool:
        """Whether two tasks or more were compared and nothing tells them apart."""
        return self.tasks > 1 and not self.differ and self.shared >= LEAST_SHARED


class _Outcomes:
    """How often each pair of state and action had each outcome, in the current task and before it."""

    def __init__(self) -> None:
        self.now: dict[Pair, Counter[Hashable]] = defaultdict(Counter)
        self.before: dict[Pair, Counter[Hashable]] = defaultdict(Counter)
        self.uncertain = False
        """Whether a pair had two outcomes within a task."""

    def add(self, pair: Pair, outcome: Hashable) -> None:
        self.now[pair][outcome] += 1
        self.uncertain = self.uncertain or len(self.now[pair]) > 1

    def shared(self) -> int:
        """Transitions of the current task in pairs that were observed before."""
        return sum(own.total() for pair, own in self.now.items() if pair in self.before)

    def differ(self) -> bool:
        contested = [
            (own, self.before[pair])
            for pair, own in self.now.items()
            if pair in self.before and len(own.keys() | self.before[pair].keys()) > 1
        ]
        if not contested or not self.uncertain:
            return bool(contested)
        # Outcomes in the order in which they were met.
        tables = [
            np.array([[row[one] for one in now + before] for row in (now, before)]) for now, before in contested
        ]
        return homogeneity(tables) < CERTAIN

    def end_task(self, keep: bool) -> None:
        if keep:
            for pair, own in self.now.items():
                self.before[pair].update(own)
        else:
            self.before.clear()
        self.now.clear()


def homogeneity(tables: list[NDArray[np.int64]]) -> float:
    """p-value of the hypothesis that the two rows of each table (2, n_outcomes) are draws of one distribution.

    The statistic is the sum of Pearson's chi² over the tables, its null distribution that of `DEALS` permutations:
    the first row is a multivariate hypergeometric draw from the column sums. The draws are the same for the same
    tables.
    """
    random = stream(len(tables), "homogeneity")
    observed, dealt = 0.0, np.zeros(DEALS)
    for table in tables:
        columns, rows = table.sum(axis=0), table.sum(axis=1)
        draws = random.multivariate_hypergeometric(columns, rows[0], DEALS)
        expected = columns * (rows[0] / rows.sum())
        # The first row decides the second: chi² is a multiple of the first row's part, the same in each deal.
        scale = rows.sum() / rows[1]
        observed += scale * float((np.square(table[0] - expected) / expected).sum())
        dealt += scale * (np.square(draws - expected) / expected).sum(axis=1)
    # Equal sums in another order differ by rounding.
    return float(1 + (dealt >= observed * (1 - 1e-9)).sum()) / (DEALS + 1)
