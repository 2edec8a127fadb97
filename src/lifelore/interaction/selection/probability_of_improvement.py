"""Probability of improvement: the probability that a policy achieves more than U⁺. Thesis: §4.5.2.1.

The thesis prints the *density* at U⁺ in place of the probability above it. A policy far better than U⁺ then scores
as low as a policy far worse. `variant="thesis"` is as printed.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.prediction import range_of_means, weighted
from lifelore.interaction.selection.rule import Array, Deterministic, RuleLibrary, Variant, check_variant

MARGIN_SHARE = 0.02
"""Default margin of the printed form, as a share of the utilities' range; the thesis gives no number."""


@dataclass(frozen=True)
class ProbabilityOfImprovement(Deterministic):
    """Σ β(τ) P(U > U⁺ | τ, π), or as printed Σ β(τ) p(U⁺ | τ, π).

    Parameters
    ----------
    target : float, optional
        U⁺. By default the best mean of any policy on any possible type; in the printed form "some utility which
        is larger than the current best estimate", Ũᵗ + `margin`.
    variant : {"standard", "thesis"}
    margin : float, optional
        Distance of the printed form's U⁺ above the best expected utility, > 0; by default 2 % of the range of mean
        utilities.

    Raises
    ------
    InputError
        `target` is not finite, `margin` not positive, or there is no such variant.

    Examples
    --------
    >>> from lifelore import PolicyLibrary
    >>> library = PolicyLibrary.from_means([[9.0, 5.0], [4.0, 8.0]], 2.0)
    >>> ProbabilityOfImprovement(target=7.0).scores(library, np.array([0.5, 0.5])).round(2).tolist()
    [0.45, 0.43]
    """

    target: float | None = None
    variant: Variant = "standard"
    margin: float | None = None
    name: ClassVar[str] = "probability-of-improvement"

    def __post_init__(self) -> None:
        check_variant(self.variant)
        if self.target is not None and not np.isfinite(self.target):
            raise InputError(f"target must be finite, got {self.target}")
        if self.margin is not None and not (self.margin > 0 and np.isfinite(self.margin)):
            raise InputError(f"margin must be positive, got {self.margin}")

    def scores(self, library: RuleLibrary, belief: Array, **_: Any) -> Array:
        """Probabilities (as printed: densities), (P,) or (k, P)."""
        model, target = library.performance, self._target(library.performance.mean, belief)
        return weighted(belief, (model.density if self.variant == "thesis" else model.exceedance)(target))

    def _target(self, mean: Array, belief: Array) -> Any:
        if self.target is not None:
            return self.target
        if self.variant == "standard":
            return np.where(belief > 0, mean.max(axis=-1), -np.inf).max(axis=-1)
        margin = MARGIN_SHARE * range_of_means(mean)[..., 0] if self.margin is None else self.margin
        return weighted(belief, mean).max(axis=-1) + margin
