"""Interval estimation: play the policy whose mean has the highest upper confidence limit (Kaelbling, 1990)."""

from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.baselines.arm_statistics import ArmStatistics
from lifelore.interaction.baselines.baseline import Baseline, library_moments

if TYPE_CHECKING:
    from lifelore.interaction.library.policy_library import PolicyLibrary

LEAST_PULLS = 2


class IntervalEstimation(Baseline):
    """Mean + q·s/√n, the upper limit for the mean of normally distributed payoffs.

    Parameters
    ----------
    alpha : float
        Probability in (0, 1) that a mean lies above its limit: q is the quantile at 1 - α.
    quantile : {"student", "normal"}
        Student's t with n - 1 degrees of freedom, as Kaelbling; or the normal's, as Vermorel and Mohri (2005).
    prior_means, prior_deviations : (n_policies,) float, optional
        As if each policy had been played `prior_pulls` times with this mean and sample deviation.
        Without them every policy is played twice first.
    prior_pulls : float or (n_policies,) float
        At least 2.
    n_policies, n_tasks, seed
        As in `Baseline`.

    `from_library` gives each policy's mean and whole deviation (between types and within them) under G₀.
    Thesis: §4.6.4.
    """

    name: ClassVar[str] = "interval-estimation"

    def __init__(
        self,
        n_policies: int,
        *,
        alpha: float = 0.05,
        quantile: str = "student",
        prior_means: ArrayLike | None = None,
        prior_deviations: ArrayLike | None = None,
        prior_pulls: ArrayLike = LEAST_PULLS,
        **common: Any,
    ) -> None:
        super().__init__(n_policies, **common)
        if not 0 < alpha < 1:
            raise InputError(f"alpha must lie between 0 and 1, got {alpha}")
        if quantile not in ("student", "normal"):
            raise InputError(f"quantile must be 'student' or 'normal', got {quantile!r}")
        if (prior_means is None) != (prior_deviations is None):
            raise InputError("prior_means and prior_deviations must be given both or neither")
        if (np.asarray(prior_pulls) < LEAST_PULLS).any():
            raise InputError(f"prior_pulls must be at least {LEAST_PULLS}, got {prior_pulls!r}")
        self.alpha, self.quantile = alpha, quantile
        self.arms = ArmStatistics.from_prior(self.rows, n_policies, prior_means, prior_pulls, prior_deviations)

    @classmethod
    def from_library(cls, library: "PolicyLibrary", **settings: Any) -> Self:
        """Means and deviations under the library's prior; `settings` override."""
        mean, spread, noise = library_moments(library)
        known: dict[str, Any] = {"prior_means": mean, "prior_deviations": np.hypot(spread, noise)}
        return cls(library.n_policies, **(known | settings))

    def _scores(self) -> NDArray[np.float64]:
        from scipy.special import ndtri, stdtrit

        pulls = np.maximum(self.arms.pulls, LEAST_PULLS)
        if self.quantile == "normal":
            wide = ndtri(1 - self.alpha)
        else:
            wide = stdtrit(pulls - 1, 1 - self.alpha)
        spread = self.arms.deviation()
        enough = self.arms.pulls >= LEAST_PULLS
        return np.where(enough, self.arms.mean + wide * np.where(enough, spread, 0.0) / np.sqrt(pulls), np.inf)

    def _learn(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        self.arms.add(policies, rewards)
