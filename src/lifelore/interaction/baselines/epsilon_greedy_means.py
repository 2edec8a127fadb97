"""ε-greedy on mean payoffs: the best policy so far, or any policy with probability ε."""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.baselines.arm_statistics import ArmBaseline, ArmStatistics
from lifelore.interaction.baselines.baseline import library_moments
from lifelore.interaction.library.policy_library import PolicyLibrary


class EpsilonGreedyMeans(ArmBaseline):
    """The policy of the largest mean with probability 1 - ε, else a random policy.

    Parameters
    ----------
    epsilon : float
        In [0, 1].
    prior_means : (n_policies,) float, optional
        Expected payoffs that count as `prior_pulls` plays. Without them every policy is played once first.
    prior_pulls : float or (n_policies,) float
        Above 0.
    n_policies, n_tasks, seed
        As in `Baseline`.

    Examples
    --------
    >>> player = EpsilonGreedyMeans(2, epsilon=0, prior_means=[0.5, 0.4])
    >>> player.update(0, 0.1)        # its mean is now (0.5 + 0.1) / 2
    >>> player.select()
    1
    """

    name: ClassVar[str] = "epsilon-greedy-means"

    def __init__(
        self,
        n_policies: int,
        *,
        epsilon: float = 0.1,
        prior_means: ArrayLike | None = None,
        prior_pulls: ArrayLike = 1.0,
        **common: Any,
    ) -> None:
        super().__init__(n_policies, **common)
        if not 0 <= epsilon <= 1:
            raise InputError(f"epsilon must lie in [0, 1], got {epsilon}")
        self.epsilon = epsilon
        self.arms = ArmStatistics.from_prior(self.rows, n_policies, prior_means, prior_pulls)

    @classmethod
    def settings_from(cls, library: PolicyLibrary) -> dict[str, Any]:
        """Prior means under the library's prior."""
        return {"prior_means": library_moments(library).mean}

    def _choose(self) -> NDArray[np.int64]:
        explored = self._generator.random(self.rows) < self.epsilon
        anything = self._generator.integers(self.n_policies, size=self.rows)
        return np.where(explored, anything, super()._choose())

    def _scores(self) -> NDArray[np.float64]:
        return np.where(self.arms.pulls > 0, self.arms.mean, np.inf)
