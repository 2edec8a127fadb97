"""The next outcome of every pair of a type and a policy: what selection rules read of an outcome model.

Arrays are (n_types, n_policies), the same for all users, or (k, n_types, n_policies) with a row for each user.
"""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.interaction.finite_signals.normal_distribution import ndtr
from lifelore.interaction.outcomes.cells import Cells

Array = NDArray[Any]

ROOT_2_PI = float(np.sqrt(2 * np.pi))


class Prediction:
    """P(next outcome | type, policy).

    Attributes
    ----------
    mean, deviation : (..., n_types, n_policies) float
    mean_variance : (..., n_types, n_policies) float or None
        Variance of the mean outcome: what is not known about it. None where means are taken as exact.
    """

    mean: Array
    deviation: Array
    mean_variance: Array | None = None

    @property
    def n_types(self) -> int:
        """Number of types."""
        return self.mean.shape[-2]

    @property
    def n_policies(self) -> int:
        """Number of policies."""
        return self.mean.shape[-1]

    def density(self, value: ArrayLike) -> Array:
        """Density (probability, where outcomes are discrete) of `value`, a number or (k,), (..., T, P)."""
        raise NotImplementedError

    def exceedance(self, threshold: ArrayLike) -> Array:
        """P(U > threshold) for every pair; thresholds (k,) give (k, T, P)."""
        raise NotImplementedError

    def expected_excess(self, threshold: ArrayLike) -> Array:
        """E[max(U − threshold, 0)] for every pair; thresholds (k,) give (k, T, P)."""
        raise NotImplementedError

    def expected_mean_excess(self, threshold: ArrayLike) -> Array:
        """E[max(m − threshold, 0)] of each pair's mean outcome m, taken as normal, (..., T, P)."""
        above = self.mean - over_pairs(threshold)
        if self.mean_variance is None:
            return np.maximum(above, 0.0)
        return normal_excess(above, np.sqrt(self.mean_variance))

    def cumulative(self, policy: int, values: Array) -> Array:
        """P(U ≤ value | type, policy) of `values` (n,), (n_types, n): a single user's, or one of each user."""
        raise NotImplementedError

    def mean_on(self, types: Any) -> Array:
        """Mean outcomes on a type for each row, (...) int to (..., n_policies)."""
        if self.mean.ndim == 2:
            return self.mean[types]
        return np.take_along_axis(self.mean, np.asarray(types)[..., None, None], axis=-2)[..., 0, :]

    def expected(self, belief: Array) -> Array:
        """Ũ(π) = Σ β(τ) E[U | τ, π] (Eq. 4.5) of beliefs (..., n_types), (..., n_policies)."""
        return weighted(belief, self.mean)


class NormalPrediction(Prediction):
    """Next outcomes taken as normal."""

    def density(self, value: ArrayLike) -> Array:
        z = (over_pairs(value) - self.mean) / self.deviation
        return np.exp(-0.5 * z * z) / (ROOT_2_PI * self.deviation)

    def exceedance(self, threshold: ArrayLike) -> Array:
        return ndtr((self.mean - over_pairs(threshold)) / self.deviation)

    def cumulative(self, policy: int, values: Array) -> Array:
        return ndtr((values[:, None] - self.mean[..., policy]) / self.deviation[..., policy]).T

    def expected_excess(self, threshold: ArrayLike) -> Array:
        return normal_excess(self.mean - over_pairs(threshold), self.deviation)


class CountedPrediction(Prediction):
    """Next outcomes in cells: a few values, or bins.

    Attributes
    ----------
    cells : Cells
    probs : (..., n_types, n_policies, n_cells) float
        P(cell | type, policy).
    """

    cells: Cells
    probs: Array

    @cached_property
    def mean(self) -> Array:  # pyright: ignore[reportIncompatibleVariableOverride]
        """E[U | type, policy], (..., n_types, n_policies)."""
        return self.probs @ self.cells.means

    @cached_property
    def deviation(self) -> Array:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Standard deviation of U, (..., n_types, n_policies)."""
        # Squares around the middle of the cells: squares of large numbers would lose their differences.
        middle = 0.5 * (self.cells.means[0] + self.cells.means[-1])
        square = self.probs @ (self.cells.variances + (self.cells.means - middle) ** 2)
        return np.sqrt(np.maximum(square - (self.mean - middle) ** 2, 0.0))

    def density(self, value: ArrayLike) -> Array:
        chosen = np.arange(len(self.cells.means)) == self.cells.of(value)[..., None]
        return self._expectation(chosen / self.cells.sizes)

    def exceedance(self, threshold: ArrayLike) -> Array:
        return self._expectation(self.cells.above(np.asarray(threshold, np.float64)[..., None]))

    def expected_excess(self, threshold: ArrayLike) -> Array:
        return self._expectation(self.cells.excess(np.asarray(threshold, np.float64)[..., None]))

    def cumulative(self, policy: int, values: Array) -> Array:
        below = 1 - self.cells.above(values[:, None])
        return (self.probs[..., policy, :] * below[:, None]).sum(axis=-1).T

    def _expectation(self, of_cells: Array) -> Array:
        """Expectation of a number of each cell, (..., n_cells) to (..., n_types, n_policies)."""
        return np.matmul(self.probs, of_cells[..., None, :, None])[..., 0]


def normal_excess(above: Array, deviation: Array) -> Array:
    """E[max(X, 0)] of normal X with mean `above`: s (z Φ(z) + φ(z)), at least 0."""
    z = above / np.maximum(deviation, 1e-300)
    # Beyond a thousand deviations, squares would leave the range of numbers and nothing changes.
    z = np.minimum(np.maximum(z, -1e3), 1e3)
    excess = deviation * (np.exp(-0.5 * z * z) / ROOT_2_PI) + above * ndtr(z)
    # Far below 0 the two terms cancel, and rounding may leave a negative number.
    return np.maximum(excess, 0.0)


def weighted(belief: Array, values: Array) -> Array:
    """Σ β(τ) v(τ, ·), (n,) or (k, n).

    Parameters
    ----------
    belief : (T,) or (k, T) float64
    values : (T, n) float64, or (k, T, n) with values of their own for each row of the belief
    """
    if values.ndim > 2:
        return np.matmul(belief[..., None, :], values)[..., 0, :]
    if belief.ndim == 1:
        belief, values = supported(belief, values)
    return belief @ values


def range_of_means(mean: Array) -> Array:
    """Largest less smallest mean of a library, (1,), or of each user's, (k, 1)."""
    return np.ptp(mean, axis=(-2, -1))[..., None]


def supported(belief: Array, *values: Array) -> tuple[Array, ...]:
    """A belief (T,) and rows of `values` (T, n) for its types of positive probability, where these are few."""
    some = belief.nonzero()[0]
    return (belief, *values) if 2 * len(some) > len(belief) else tuple(each[some] for each in (belief, *values))


def over_pairs(values: ArrayLike) -> Any:
    """A number as it is, a batch (...,) as (..., 1, 1), which broadcasts against (n_types, n_policies)."""
    return values if isinstance(values, float | int) else np.asarray(values)[..., None, None]


def over_types(values: ArrayLike) -> Any:
    """A number as it is, a batch (...,) as (..., 1), which broadcasts against (n_types,)."""
    return values if isinstance(values, float | int) else np.asarray(values, np.float64)[..., None]
