"""Policy reuse as straightforward loops: over types, policies, signals and points of an integral, posterior by
posterior.

The selection rules of §4.5.2 written down as one would from their formulas, on NumPy arrays. They select as
our own rules do, which the benchmark checks before it times anything.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

POINTS = 100
"""Steps of the integral in expected improvement."""


def density(value: float, mean: float, deviation: float) -> float:
    """Density of a normal at one point."""
    return np.exp(-0.5 * ((value - mean) / deviation) ** 2) / (deviation * np.sqrt(2 * np.pi))


def updated(belief: Array, mean: Array, deviation: Array, policy: int, value: float) -> Array:
    """Bayes' rule, type by type."""
    new = np.empty(len(belief))
    for i in range(len(belief)):
        new[i] = density(value, mean[i, policy], deviation[i, policy]) * belief[i]
    return new / new.sum()


def utilities(belief: Array, mean: Array) -> Array:
    """Expected utility of each policy, by a sum over types."""
    worth = np.empty(mean.shape[1])
    for q in range(mean.shape[1]):
        worth[q] = np.sum(belief * mean[:, q])
    return worth


def expected_improvement(belief: Array, mean: Array, deviation: Array, top: float) -> Array:
    """The integral of (u − Uᵗ) p(u) from Uᵗ to `top`, by the rule of the midpoint."""
    best = utilities(belief, mean).max()
    width = (top - best) / POINTS
    values = np.empty(mean.shape[1])
    for q in range(mean.shape[1]):
        total = 0.0
        for i in range(len(belief)):
            for k in range(POINTS):
                gain = (k + 0.5) * width
                total += belief[i] * gain * density(best + gain, mean[i, q], deviation[i, q]) * width
        values[q] = total
    return values


def belief_entropy(belief: Array, mean: Array, probs: Array, kappa: float) -> Array:
    """Utility less κ times the entropy to expect; `probs` (n_policies, n_types, n_signals)."""
    return utilities(belief, mean) - kappa * expected_entropies(belief, probs)


def information_ratio(belief: Array, mean: Array, probs: Array) -> Array:
    """Expected regret squared for each nat that the entropy is expected to fall by."""
    lost = np.sum(belief * mean.max(axis=1)) - utilities(belief, mean)
    before = -np.sum(belief * np.log(np.where(belief > 0, belief, 1.0)))
    return lost**2 / np.maximum(before - expected_entropies(belief, probs), 1e-9)


def expected_entropies(belief: Array, probs: Array) -> Array:
    """Entropy of every policy's and signal's posterior, weighted by the signal's probability."""
    found = np.zeros(len(probs))
    for q in range(len(probs)):
        for s in range(probs.shape[2]):
            joint = probs[q, :, s] * belief
            chance = joint.sum()
            if chance > 0:
                after = joint / chance
                found[q] -= chance * np.sum(after * np.log(np.where(after > 0, after, 1.0)))
    return found


def knowledge_gradient(belief: Array, mean: Array, probs: Array, left: float) -> Array:
    """Utility, and `left` times how much better the best is expected to be, posterior by posterior."""
    worth = utilities(belief, mean)
    gained = np.zeros(len(probs))
    for q in range(len(probs)):
        for s in range(probs.shape[2]):
            joint = probs[q, :, s] * belief
            chance = joint.sum()
            if chance > 0:
                gained[q] += chance * ((joint / chance) @ mean).max()
    return worth + left * (gained - worth.max())
