"""Sliding-window UCB: upper confidence bounds from the last plays, for payoffs that change.

Garivier and Moulines, On upper-confidence bound policies for switching bandit problems, 2011. With τ the window, N
the plays of a policy among the last τ, and X their mean payoff:

    X + B·√(ξ ln min(t, τ) / N)

B is the width of the `scale`. It is UCB1 on the last τ plays, with c = √(ξ / 2).
"""

from collections import deque
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.baselines.ucb1 import UCB1, to_unit

XI = 0.6
"""ξ of the paper's experiments; its bounds on regret need more than 1/2."""


class SlidingWindowUCB(UCB1):
    """UCB1 on the last `window` plays; prior means are not forgotten.

    Parameters
    ----------
    window : int
        τ ≥ 1, number of plays that count; fewer forget sooner. The paper derives
        2·√(T ln T / changes) for T plays.
    exploration : float
        c = √(ξ / 2); ξ = 0.6 by default, as in the paper's experiments.
    scale, prior_means, prior_pulls, n_policies, n_tasks, seed
        As in `UCB1`.

    Examples
    --------
    >>> player = SlidingWindowUCB(2, window=2)
    >>> for policy in (0, 1, 1):
    ...     player.update(policy, 1.0)
    >>> player.select()    # no play of policy 0 is left
    0
    """

    name: ClassVar[str] = "sliding-window-ucb"

    def __init__(
        self,
        n_policies: int,
        *,
        window: int = 100,
        exploration: float = (XI / 2) ** 0.5,
        **settings: Any,
    ) -> None:
        super().__init__(n_policies, exploration=exploration, **settings)
        if not window >= 1:
            raise InputError(f"window must be at least 1, got {window}")
        self.window = window
        self._recent: deque[tuple[NDArray[np.int64], NDArray[np.float64]]] = deque()

    def _learn(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        super()._learn(policies, rewards)
        self._recent.append((policies, to_unit(rewards, self.scale)))
        if len(self._recent) > self.window:
            self.arms.remove(*self._recent.popleft())
