"""Gaussian outcomes of every type and policy: the default performance model.

Thesis: §4.3.4, Fig. 4.1; the expected excess is the textbook expected improvement of a Gaussian.
"""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.interaction.outcomes.batch_likelihood import BatchLikelihood, NormalLikelihood, Normals
from lifelore.interaction.outcomes.moment_outcomes import MomentOutcomes
from lifelore.interaction.outcomes.outcome_model import is_outcome, over_pairs, refuse_outcome
from lifelore.interaction.outcomes.outcome_moments import known_moments
from lifelore.interaction.outcomes.special_functions import ndtr

Array = NDArray[np.float64]

_LOG_ROOT_2_PI = 0.5 * np.log(2 * np.pi)
_ROOT_2_PI = np.sqrt(2 * np.pi)


class GaussianOutcomes(MomentOutcomes):
    """P(U | type, policy) = Normal(mean, deviation²).

    Parameters
    ----------
    mean : (n_types, n_policies) float
        Finite.
    deviation : float or (n_types, n_policies) float
        Positive.
    count : float or (n_types, n_policies) float, optional
        Number of samples behind the numbers, so that `observe` can change them; without it they are exact.

    Raises
    ------
    InputError
        A mean is not finite, a deviation or count not positive, or shapes do not agree.

    Examples
    --------
    >>> model = GaussianOutcomes([[0.0, 1.0], [2.0, 1.0]], 1.0)
    >>> model.expected_excess(0.0).round(3).tolist()
    [[0.399, 1.083], [2.008, 1.083]]
    """

    kind: ClassVar[str] = "gaussian"

    def __init__(self, mean: ArrayLike, deviation: ArrayLike, count: ArrayLike | None = None) -> None:
        super().__init__(known_moments(mean, deviation, count))

    def log_density(self, policy: int, value: float) -> Array:
        """Log density of `value` per type, (n_types,).

        Raises
        ------
        InputError
            `value` is no finite number.
        NotFoundError
            There is no such policy.
        """
        if not is_outcome(policy, value, self._centre.shape[0]):
            refuse_outcome(policy, value, self.n_policies)
        z = (value - self._centre[policy]) * self._precision[policy]
        z *= z
        z *= -0.5
        z += self._log_height[policy]
        return z

    def log_densities(self, policies: NDArray[np.int64], values: Array) -> Array:
        """`log_density` of many outcomes, (n,) and (n,) to (n, n_types); without checks."""
        z = np.asarray(values, np.float64)[:, None] - self._centre[policies]
        z *= self._precision[policies]
        z *= z
        z *= -0.5
        z += self._log_height[policies]
        return z

    def batch_likelihood(self) -> BatchLikelihood:
        """The normals' arrays; for a subclass, calls of its `log_densities`."""
        if type(self) is not GaussianOutcomes:
            return super().batch_likelihood()
        return NormalLikelihood(Normals(self._centre, self._precision, self._log_height))

    def density(self, value: ArrayLike) -> Array:
        """Density of `value` for every pair, (..., n_types, n_policies)."""
        z = (over_pairs(value) - self.mean) / self.deviation
        return np.exp(-0.5 * z * z) / (_ROOT_2_PI * self.deviation)

    def exceedance(self, threshold: ArrayLike) -> Array:
        """P(U > threshold) for every pair, (..., n_types, n_policies)."""
        return ndtr((self.mean - over_pairs(threshold)) / self.deviation)

    def expected_excess(self, threshold: ArrayLike) -> Array:
        """E[max(U - threshold, 0)] = s (z Φ(z) + φ(z)) for every pair, (..., n_types, n_policies)."""
        z = self.mean - over_pairs(threshold)
        z /= self.deviation
        excess = z * z
        excess *= -0.5
        np.exp(excess, out=excess)
        excess *= 1 / _ROOT_2_PI
        z *= ndtr(z)
        excess += z
        excess *= self.deviation
        # Far below the threshold the two terms cancel, and rounding may leave a negative number.
        return np.maximum(excess, 0.0, out=excess)

    def cumulative(self, policy: int, values: Array, types: Any = slice(None)) -> Array:
        """P(U ≤ value | type, policy) of `values` (n,), for all or some types, (n_types, n)."""
        z = values - self._centre[policy, types][:, None]
        return ndtr(z * self._precision[policy, types][:, None])

    def sample(self, generator: np.random.Generator, type_: int, policy: int, size: Any = None) -> Any:
        """Random outcomes of a pair: a number, or an array of shape `size`."""
        return generator.normal(self.mean[type_, policy], self.deviation[type_, policy], size)

    def _prepare(self) -> None:
        self.deviation = np.sqrt(self.moments.variance)
        # Policy first: an update reads the row of a policy.
        self._centre = np.ascontiguousarray(self.mean.T)
        self._precision = np.ascontiguousarray(1 / self.deviation.T)
        self._log_height = np.log(self._precision) - _LOG_ROOT_2_PI

    def _renew(self, type_: int, policy: int) -> None:
        self.deviation[type_, policy] = np.sqrt(self.moments.variance[type_, policy])
        self._centre[policy, type_] = self.mean[type_, policy]
        self._precision[policy, type_] = 1 / self.deviation[type_, policy]
        self._log_height[policy, type_] = np.log(self._precision[policy, type_]) - _LOG_ROOT_2_PI
