"""UCB1: play the policy whose mean payoff could be the largest (Auer, Cesa-Bianchi and Fischer, 2002)."""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.baselines.arm_statistics import ArmBaseline, ArmStatistics
from lifelore.interaction.baselines.baseline import LEAST, Moments, library_moments
from lifelore.interaction.library.policy_library import PolicyLibrary


class UCB1(ArmBaseline):
    """Upper confidence bounds: mean + c·√(2 ln t / n), c = `exploration`, payoffs mapped to [0, 1] by `scale`.

    Parameters
    ----------
    exploration : float
        c ≥ 0; 1 is the printed algorithm. On few and noisy plays much smaller values do better.
    scale : (float, float), optional
        Payoffs that are mapped to 0 and 1, by default (0, 1). Payoffs are not clipped.
    prior_means : (n_policies,) float, optional
        Expected payoffs in units of payoffs; no policy then has to be tried first.
    prior_pulls : float or (n_policies,) float
        Number of plays that the prior means count as, in n and in t.
    n_policies, n_tasks, seed
        As in `Baseline`.

    `from_library` gives the prior means under G₀ and an interval of width σ as the scale (`fitting_scale`).
    Thesis: §4.6.4, Fig. 4.11, with the library's bounds as the scale.

    Examples
    --------
    >>> player = UCB1(2, prior_means=[0.2, 0.6])
    >>> player.select()
    1
    """

    name: ClassVar[str] = "ucb1"

    def __init__(
        self,
        n_policies: int,
        *,
        exploration: float = 1.0,
        scale: tuple[float, float] | None = None,
        prior_means: ArrayLike | None = None,
        prior_pulls: ArrayLike = 1.0,
        **common: Any,
    ) -> None:
        super().__init__(n_policies, **common)
        if not (exploration >= 0 and np.isfinite(exploration)):
            raise InputError(f"exploration must be finite and at least 0, got {exploration}")
        self.exploration, self.scale = exploration, checked_scale(scale)
        means = None if prior_means is None else to_unit(np.asarray(prior_means, np.float64), self.scale)
        self.arms = ArmStatistics.from_prior(self.rows, n_policies, means, prior_pulls)

    @classmethod
    def settings_from(cls, library: PolicyLibrary) -> dict[str, Any]:
        """Prior means under the library's prior, scale of the width of payoffs' deviation."""
        moments = library_moments(library)
        return {"prior_means": moments.mean, "scale": fitting_scale(moments)}

    def _scores(self) -> NDArray[np.float64]:
        pulls = self.arms.pulls
        # Fewer than one pull in all would have a negative logarithm.
        seen = np.log(np.maximum(pulls.sum(axis=1, keepdims=True), 1.0))
        wide = np.sqrt(2 * seen / np.where(pulls > 0, pulls, 1.0))
        return np.where(pulls > 0, self.arms.mean + self.exploration * wide, np.inf)

    def _learn(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        super()._learn(policies, to_unit(rewards, self.scale))


def fitting_scale(moments: Moments) -> tuple[float, float]:
    """An interval of width σ about the mean payoff, (low, high): the bonus is then σ·√(2 ln t / n).

    The mean of n payoffs that are sub-Gaussian with deviation σ is below its expectation by more than
    σ·√(2 ln t / n) with probability at most 1/t. For normal payoffs this bonus has the least regret in the long
    run (Katehakis and Robbins, 1995). The bounds of a library of normal outcomes are wider than eight deviations,
    so with them the bonus exceeds all differences of means for hundreds of plays.

    σ is the larger of two deviations: of a payoff from its type's mean, and of the types' means, which is the
    error of a prior mean that counts as a play; root mean square over policies.
    """
    deviation = max(float(np.sqrt((np.maximum(moments.spread, moments.noise) ** 2).mean())), LEAST)
    centre = float(moments.mean.mean())
    return centre - deviation / 2, centre + deviation / 2


def checked_scale(scale: tuple[float, float] | None) -> tuple[float, float]:
    """(low, high) with low < high; (0, 1) for None."""
    low, high = (0.0, 1.0) if scale is None else (float(scale[0]), float(scale[1]))
    if not (np.isfinite([low, high]).all() and low < high):
        raise InputError(f"scale must be (low, high), finite and low < high, got {scale}")
    return low, high


def to_unit(rewards: NDArray[np.float64], scale: tuple[float, float]) -> NDArray[np.float64]:
    """Payoffs with `scale` mapped to (0, 1)."""
    return (rewards - scale[0]) / (scale[1] - scale[0])
