"""Which actions of a finished task teach the prior: U of Eq. 3.5, also where no value is positive.

A task with a positive value teaches by sign: in each state with a positive value, the best actions (§3.3).

In a world whose rewards are never positive (a cost for each step), no value is positive, and 0 is the value of
an action never tried. Such a task teaches by its returns, relative to its best return: U(s, a) = 1 where a has
the largest value among the actions that were taken in s in the best tenth of the episodes, of those that ended.
A task whose episodes all have the same return, or of which no episode of the best tenth ended, teaches nothing.
"""

from collections.abc import Hashable, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.external_world.episode import Step
from lifelore.core.planning.planning import best_actions, learnt_best_actions

BEST_SHARE = 10
"""One episode in so many counts as one of the best; fewer episodes give fewer, and more reliable, counts."""


class EpisodeReturns:
    """Returns of a task's episodes, and the highest return with which each action was taken in each state."""

    def __init__(self, n_actions: int) -> None:
        self.n_actions = n_actions
        self.returns: list[float] = []
        self._highest: dict[tuple[Hashable, int], NDArray[np.float64]] = {}

    def add(self, steps: Sequence[Step], earned: float, ended: bool) -> None:
        """Add an episode; `ended`: the world terminated it."""
        self.returns.append(earned)
        if not ended:
            return
        for step in steps:
            pair = step.state, step.context
            if pair not in self._highest:
                self._highest[pair] = np.full(self.n_actions, -np.inf)
            self._highest[pair][step.action] = max(self._highest[pair][step.action], earned)

    def taken_in_best(self, visited: Sequence[tuple[Hashable, int]]) -> NDArray[np.bool_]:
        """Actions taken in the best tenth of the episodes, (n, n_actions); all False if all returns are equal."""
        never = np.full(self.n_actions, -np.inf)
        highest = np.array([self._highest.get(pair, never) for pair in visited]).reshape(-1, self.n_actions)
        if not self.returns or min(self.returns) == max(self.returns):
            return np.zeros(highest.shape, bool)
        return highest >= sorted(self.returns)[-max(1, len(self.returns) // BEST_SHARE)]


def useful_actions(
    q: NDArray[np.float64], visited: Sequence[tuple[Hashable, int]], returns: EpisodeReturns
) -> NDArray[np.bool_]:
    """U of each visited (state, context code) with values `q` (n, n_actions); see the module's first lines."""
    if not q.size or q.max() > 0:
        return learnt_best_actions(q) & (q.max(axis=1, keepdims=True) > 0)
    taken = returns.taken_in_best(visited)
    return best_actions(np.where(taken, q, -np.inf), floor=0.0) & taken
