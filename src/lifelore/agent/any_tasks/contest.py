"""A contest of learners in one task: the policy of a known type that goes on, and one that learns from nothing.

A seed helps where tasks are alike and misleads where they are not, and a policy may be caught in a poor habit. So
both learn from each step, whoever makes it, and each episode is played by the one of the larger recent return
(after Fernández and Veloso, 2006). Who learns from nothing needs patience: for its first episodes it counts as
what such learners usually reach in the end.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.any_tasks.learners import Player
from lifelore.agent.external_world.episode import Step

RECENT = 3
"""Episodes whose mean return says how well a learner does now."""


class Contest:
    """Two learners of one task; a `Player`.

    Parameters
    ----------
    seeded, fresh : Player
        The second learns from nothing.
    hope : float
        Return that learners from nothing usually reach in the end; infinity where nothing is known of them.
    patience : int
        Episodes that the second may play before only what it has reached counts.
    """

    def __init__(self, seeded: Player, fresh: Player, hope: float, patience: int) -> None:
        self.players, self.hope, self.patience = (seeded, fresh), hope, patience
        self.returns: tuple[list[float], list[float]] = ([], [])
        self.turn = 0

    @property
    def fresh_returns(self) -> Sequence[float]:
        """Returns of the episodes played by the one that learns from nothing."""
        return self.returns[1]

    def knows(self, state: int) -> bool:
        """Whether the one whose turn it is has met a state."""
        return self.players[self.turn].knows(state)

    def act(self, state: int, context: int, explore: bool) -> int:
        """The action of the one whose turn it is."""
        return self.players[self.turn].act(state, context, explore)

    def observe(self, step: Step) -> None:
        """Both learn from a step."""
        for player in self.players:
            player.observe(step)

    def end_episode(self, steps: list[Step], earned: float, ended: bool) -> None:
        """Both learn from an episode; then it is the turn of the better one."""
        for player in self.players:
            player.end_episode(steps, earned, ended)
        self.returns[self.turn].append(earned)
        self.turn = self.better()

    def better(self) -> int:
        """The one of the larger recent return; the second is hoped for as long as patience lasts."""
        seeded, fresh = self._recent
        if len(self.returns[1]) < self.patience:
            fresh = max(fresh, self.hope)
        return int(fresh > seeded)

    def winner(self) -> int:
        """The one that has reached more, whatever was hoped for."""
        seeded, fresh = self._recent
        return int(fresh > seeded)

    @property
    def _recent(self) -> list[float]:
        return [float(np.mean(one[-RECENT:])) if one else -np.inf for one in self.returns]

    def policy(self) -> Any:
        """What the better one has learnt."""
        return self.players[self.winner()].policy()

    def best(self) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Contexts of visited states and useful actions, of the better one."""
        return self.players[self.winner()].best()
