"""Try every policy, then play the best: the use of a library of policies without models."""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.baselines.arm_statistics import ArmBaseline, ArmStatistics


class TryAll(ArmBaseline):
    """Each policy `rounds` times in a random order for each task, then the policy of the best mean for ever.

    Parameters
    ----------
    rounds : int
        At least 1. Rounds after the first go through the policies in the same order.
    n_policies, n_tasks, seed
        As in `Baseline`.

    Thesis: §4.6.4, "a brute force strategy which involved testing every policy in turn".

    Examples
    --------
    >>> player = TryAll(3)
    >>> for payoff in (0.1, 0.9, 0.5):
    ...     last = player.select()
    ...     player.update(last, 0.9 if last == 1 else 0.1)
    >>> player.select()
    1
    """

    name: ClassVar[str] = "try-all"

    def __init__(self, n_policies: int, *, rounds: int = 1, **common: Any) -> None:
        super().__init__(n_policies, **common)
        if not rounds >= 1:
            raise InputError(f"rounds must be at least 1, got {rounds}")
        self.rounds = rounds
        self.arms = ArmStatistics.empty(self.rows, n_policies)
        self._turn = self._generator.random((self.rows, n_policies))

    def _scores(self) -> NDArray[np.float64]:
        waiting = self.arms.pulls < self.rounds
        # Policies with fewer plays come first; equals in the order drawn at the start.
        first = self.rounds - self.arms.pulls + self._turn
        # A task that has tried all policies plays by means; other tasks continue in their order.
        return np.where(waiting.any(axis=1, keepdims=True), np.where(waiting, first, -np.inf), self.arms.mean)
