"""The law of signals where no known type fits: broad around the mean of the types, and learnt policy by policy.

Outcomes: mean and variance of a policy have a normal-inverse-χ² prior around the pooled mean, as wide as the
spread over types. After k outcomes with mean x̄ and sum of squares S, the next outcome has a Student's t
distribution:

    κ = κ₀ + k     m = (κ₀ m₀ + k x̄) / κ     ν = ν₀ + k     ν v = ν₀ v₀ + S + (κ₀ k / κ)(x̄ − m₀)²
    t with ν degrees of freedom, location m, scale² = v (1 + 1/κ)

Categories: a Dirichlet prior around the pooled probabilities, whose weight follows from the spread over types.
"""

from math import lgamma, log, log1p, pi
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.library.signal_laws import CategoryLaws, SignalLaws

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

FREEDOM = 5.0
"""Degrees of freedom ν₀ of the variance: the number of outcomes that the types' mean variance counts as."""
LEAST_SPREAD = 0.1
"""Least spread over types, in deviations of an outcome: types that agree on a policy do not bind a new type."""
UNIFORM = 0.01
"""Share of the uniform distribution in pooled probabilities, so that every category is possible."""
WEIGHTS = (0.5, 1000.0)
"""Least and largest number of signals that the pooled probabilities count as."""


class BroadLaw(Protocol):
    """The law of signals of an unknown type; `shown` is what a task has shown, one row for each policy."""

    width: int
    """Numbers that are stored for a policy."""

    def log_density(self, shown: Array, policies: Numbers, signals: Array) -> Array:
        """Log density of signals (n,), given the policies' rows `shown` (n, width)."""
        ...

    def learn(self, shown: Array, signals: Array) -> None:
        """Take in signals (n,), in place."""
        ...


class BroadNormals:
    """The law of outcomes.

    Parameters
    ----------
    mean, deviation : (n_types, n_policies) float
        Of the outcomes of known types.
    prior : (n_types,) float
    """

    width = 3

    def __init__(self, mean: Array, deviation: Array, prior: Array) -> None:
        self.centre = prior @ mean
        self.variance = np.maximum(prior @ deviation**2, 1e-300)
        spread = prior @ (mean - self.centre) ** 2
        self.weight = self.variance / np.maximum(spread, LEAST_SPREAD**2 * self.variance)

    def log_density(self, shown: Array, policies: Numbers, signals: Array) -> Array:
        """Log density of Student's t."""
        if len(signals) == 1:
            return np.array([self._log_density(int(policies[0]), shown[0].tolist(), float(signals[0]))])
        from scipy.special import gammaln  # imported at its first use: a single signal does without

        k, mean, squares = shown.T
        centre, weight = self.centre[policies], self.weight[policies]
        total, freedom = weight + k, FREEDOM + k
        off = mean - centre
        variance = (FREEDOM * self.variance[policies] + squares + weight * k / total * off * off) / freedom
        location = centre + k / total * off
        scale2 = variance * (1 + 1 / total)
        z2 = (signals - location) ** 2 / scale2
        half = 0.5 * freedom
        height = gammaln(half + 0.5) - gammaln(half) - 0.5 * np.log(np.pi * freedom * scale2)
        return height - (half + 0.5) * np.log1p(z2 / freedom)

    def _log_density(self, policy: int, shown: list[float], signal: float) -> float:
        """`log_density` of a single signal, ten times as fast."""
        k, mean, squares = shown
        centre, weight = float(self.centre[policy]), float(self.weight[policy])
        total, half, off = weight + k, 0.5 * (FREEDOM + k), mean - centre
        # Degrees of freedom times the scale² of the t distribution.
        scale2 = (FREEDOM * float(self.variance[policy]) + squares + weight * k / total * off * off) * (
            1 + 1 / total
        )
        z = signal - (centre + k / total * off)
        return lgamma(half + 0.5) - lgamma(half) - 0.5 * log(pi * scale2) - (half + 0.5) * log1p(z * z / scale2)

    def learn(self, shown: Array, signals: Array) -> None:
        """Count, mean and sum of squares (Welford's update)."""
        k, mean, squares = shown.T  # views: the rows change in place
        before = signals - mean
        k += 1
        mean += before / k
        squares += before * (signals - mean)


class BroadCategories:
    """The law of categories.

    Parameters
    ----------
    probs : (n_types, n_policies, n_categories) float
    prior : (n_types,) float
    """

    def __init__(self, probs: Array, prior: Array) -> None:
        self.width = probs.shape[2]
        pooled = np.tensordot(prior, probs, axes=1)
        spread = np.tensordot(prior, (probs - pooled) ** 2, axes=1).sum(axis=1)
        noise = (pooled * (1 - pooled)).sum(axis=1)
        weight = np.divide(noise, spread, out=np.full(len(noise), np.inf), where=spread > 0) - 1
        pooled = (1 - UNIFORM) * pooled + UNIFORM / self.width
        self.counts = pooled * np.clip(weight, *WEIGHTS)[:, None]

    def log_density(self, shown: Array, policies: Numbers, signals: Array) -> Array:
        """Log probability of category numbers."""
        counts = self.counts[policies] + shown
        chosen = np.take_along_axis(counts, signals.astype(np.int64)[:, None], axis=1)[:, 0]
        return np.log(chosen / counts.sum(axis=1))

    def learn(self, shown: Array, signals: Array) -> None:
        """Count the categories."""
        shown[np.arange(len(shown)), signals.astype(np.int64)] += 1


def broad_law(library: PolicyLibrary, laws: SignalLaws) -> Any:
    """The law of a library's signals where no known type fits."""
    if isinstance(laws, CategoryLaws):
        return BroadCategories(laws.probs, library.prior)
    return BroadNormals(library.performance.mean, library.performance.deviation, library.prior)
