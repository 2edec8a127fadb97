"""Thompson sampling: draw each policy's mean payoff from its posterior, play the largest."""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.interaction.baselines.arm_statistics import ArmBaseline, ArmStatistics
from lifelore.interaction.baselines.baseline import LEAST, library_moments, row_of
from lifelore.interaction.library.policy_library import PolicyLibrary


class GaussianThompson(ArmBaseline):
    """Normal payoffs of known noise, normal beliefs about each policy's mean, independent of one another.

    After n payoffs of mean m the belief is normal with precision 1/s₀² + n/σ² and mean
    (m₀/s₀² + n m/σ²) / precision.

    Parameters
    ----------
    prior_means, prior_deviations : float or (n_policies,) float
        m₀ and s₀ > 0 of the prior of each mean.
    noise : float or (n_policies,) float
        σ > 0 of a payoff.
    n_policies, n_tasks, seed
        As in `Baseline`.

    `from_library` takes all three under the library's prior over types.

    Examples
    --------
    >>> player = GaussianThompson(2, noise=0.1)
    >>> player.update(0, 1.0)
    >>> player.beliefs()[0].round(2).tolist()
    [[0.99, 0.0]]
    """

    name: ClassVar[str] = "thompson"

    def __init__(
        self,
        n_policies: int,
        *,
        prior_means: ArrayLike = 0.0,
        prior_deviations: ArrayLike = 1.0,
        noise: ArrayLike = 1.0,
        **common: Any,
    ) -> None:
        super().__init__(n_policies, **common)
        self._start = row_of("prior_means", prior_means, n_policies)
        self._start_precision = row_of("prior_deviations", prior_deviations, n_policies, least=0.0) ** -2
        self._noise_precision = row_of("noise", noise, n_policies, least=0.0) ** -2
        self.arms = ArmStatistics.empty(self.rows, n_policies)

    @classmethod
    def settings_from(cls, library: PolicyLibrary) -> dict[str, Any]:
        """Beliefs and noise under the library's prior."""
        mean, spread, noise = library_moments(library)
        return {
            "prior_means": mean,
            "prior_deviations": np.maximum(spread, LEAST),
            "noise": np.maximum(noise, LEAST),
        }

    def beliefs(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Posterior mean and deviation of each policy's mean payoff, (rows, n_policies) each."""
        seen = self.arms.pulls * self._noise_precision
        precision = self._start_precision + seen
        mean = (self._start_precision * self._start + seen * self.arms.mean) / precision
        return mean, precision**-0.5

    def _scores(self) -> NDArray[np.float64]:
        return self._generator.normal(*self.beliefs())
