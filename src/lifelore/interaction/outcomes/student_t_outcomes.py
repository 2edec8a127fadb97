"""Student's t outcomes: the predictive distribution of a Gaussian whose mean and variance are uncertain.

The prior on the mean is the reference prior; the prior on the variance is an inverse χ² around the pooled
variance, which counts as `shrinkage` samples. The next outcome then has a t distribution with the sample mean as
location, scale² = variance (1 + 1 / count), and the degrees of freedom of the variance. Agents with uncertain
models predict so from Gaussian outcomes, too. Thesis: §4.4.1, step 4.
"""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.normal_law import NormalLaw, log_t_height
from lifelore.interaction.outcomes.prediction import over_pairs
from lifelore.interaction.outcomes.special_functions import stdtr
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[np.float64]


class StudentTOutcomes(GaussianOutcomes):
    """P(U | type, policy) = t(freedom) around a location, in units of a scale.

    Parameters
    ----------
    mean : (n_types, n_policies) float
        Sample means.
    deviation : float or (n_types, n_policies) float
        Sample deviations, positive.
    count : float or (n_types, n_policies) float
        Number of samples behind them, more than 2.

    Raises
    ------
    InputError
        As for `GaussianOutcomes`, or fewer than three degrees of freedom would leave no deviation.
    """

    kind: ClassVar[str] = "student-t"

    @property
    def freedom(self) -> Array:
        """Degrees of freedom, (n_types, n_policies)."""
        return self.moments.freedom

    def log_densities(self, policies: Any, values: Any) -> Array:
        """Log densities of many outcomes, (...) and (...) to (..., n_types); without checks."""
        return self._law.log_likelihoods(policies, values)[..., 0, :]

    def density(self, value: ArrayLike) -> Array:
        """Density of `value` for every pair, (..., n_types, n_policies)."""
        return self._unit_density((over_pairs(value) - self.mean) / self.scale) / self.scale

    def exceedance(self, threshold: ArrayLike) -> Array:
        """P(U > threshold) for every pair, (..., n_types, n_policies)."""
        return stdtr(self.freedom, (self.mean - over_pairs(threshold)) / self.scale)

    def expected_excess(self, threshold: ArrayLike) -> Array:
        """E[max(U - threshold, 0)] for every pair, (..., n_types, n_policies).

        With z = (mean - threshold) / s, and f and F the density and distribution of t with ν degrees of freedom:
        s (f(z) (ν + z²) / (ν - 1) + z F(z)).
        """
        z = (self.mean - over_pairs(threshold)) / self.scale
        peak = self._unit_density(z) * (self.freedom + z * z) / (self.freedom - 1)
        # Far below the threshold the two terms cancel, and rounding may leave a negative number.
        return np.maximum(self.scale * (peak + z * stdtr(self.freedom, z)), 0.0)

    def cumulative(self, policy: int, values: Array) -> Array:
        """P(U ≤ value | type, policy) of `values` (n,), (n_types, n)."""
        return stdtr(
            self.freedom[:, policy, None], (values - self.mean[:, policy, None]) / self.scale[:, policy, None]
        )

    def sample(self, generator: np.random.Generator, type_: int, policy: int, size: Any = None) -> Any:
        """Random outcomes of a pair: a number, or an array of shape `size`."""
        drawn = generator.standard_t(self.freedom[type_, policy], size)
        return self.mean[type_, policy] + self.scale[type_, policy] * drawn

    def _unit_density(self, z: Array) -> Array:
        return np.exp(self._unit_height - 0.5 * (self.freedom + 1) * np.log1p(z * z / self.freedom))

    def _prepare(self) -> None:
        if not ((self.freedom > 2) & np.isfinite(self.freedom)).all():
            raise InputError(
                "every pair needs more than 2 and finitely many degrees of freedom (shrinkage + samples - 1, or "
                "count); raise shrinkage, or use GaussianOutcomes for exact numbers"
            )
        self.mean = self.moments.mean
        self.scale: Array = np.sqrt(self.moments.variance * (1 + 1 / self.moments.count))
        self.deviation = self.scale * np.sqrt(self.freedom / (self.freedom - 2))
        self._unit_height = log_t_height(self.freedom)
        self._law = NormalLaw(self.moments, Spread.known(0.0))
