"""Interval estimation: play the policy whose mean has the highest upper confidence limit (Kaelbling, 1990)."""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.baselines.arm_statistics import ArmBaseline, ArmStatistics
from lifelore.interaction.baselines.baseline import library_moments
from lifelore.interaction.library.policy_library import PolicyLibrary

LEAST_PULLS = 2


class IntervalEstimation(ArmBaseline):
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

    Examples
    --------
    >>> player = IntervalEstimation(2)
    >>> for policy, payoff in ((0, 1.0), (0, 1.1), (1, 3.0), (1, 3.1)):
    ...     player.update(policy, payoff)
    >>> player.select()
    1
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
    def settings_from(cls, library: PolicyLibrary) -> dict[str, Any]:
        """Means and deviations under the library's prior."""
        mean, spread, noise = library_moments(library)
        return {"prior_means": mean, "prior_deviations": np.hypot(spread, noise)}

    def _scores(self) -> NDArray[np.float64]:
        from scipy.special import ndtri, stdtrit

        pulls = np.maximum(self.arms.pulls, LEAST_PULLS)
        wide = ndtri(1 - self.alpha) if self.quantile == "normal" else stdtrit(pulls - 1, 1 - self.alpha)
        deviation = np.sqrt(self.arms.squares / (pulls - 1))
        limit = self.arms.mean + wide * deviation / np.sqrt(pulls)
        return np.where(self.arms.pulls >= LEAST_PULLS, limit, np.inf)
