"""Fit of normals that are seen only through the category in which they fall, by penalised maximum likelihood.

    P(category k | τ, π) = Φ((c_k - μ(τ,π)) / σ(τ,π)) - Φ((c_{k-1} - μ(τ,π)) / σ(τ,π)),    c_0 = -∞, c_K = ∞

Means and deviations belong to pairs, the cut points c to all pairs. Internal units make the common deviation 1 and
the first cut point 0. Three penalties leave no number open where samples do not determine it: deviations are near
the common deviation, means within the range of the cut points, and every category has probability over all pairs.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LEAST_RANGE = 2.0
"""Smallest prior deviation of means, in common deviations; with two categories there is no range of cut points."""
UNSEEN = 0.5
"""Additional samples of every category, of all pairs together; more makes bands of unseen categories wider."""
LOG_LIMIT = 5.0
"""Largest size of the logarithm of a deviation or of a gap between cut points, in common deviations."""
SEARCH = {"ftol": 1e-10, "maxiter": 2000, "maxfun": 5000}
"""The search ends at a relative fall of the objective below `ftol`; a larger number leaves far means too near."""


class OrderedNormals(NamedTuple):
    """A fit.

    mean, deviation : (n_types, n_policies) float64
        The deviation includes the uncertainty of the mean.
    cuts : (n_categories - 1,) float64
        Rising.
    """

    mean: Array
    deviation: Array
    cuts: Array


def log_probabilities(mean: Array, deviation: Array, cuts: Array) -> Array:
    """Log probability of each category, (..., n_categories), of normals (...,) between rising cut points."""
    from scipy.special import log_ndtr

    bounds = (cuts - mean[..., None]) / deviation[..., None]
    ends = np.full((*mean.shape, 1), np.inf)
    low, high = np.concatenate([-ends, bounds], axis=-1), np.concatenate([bounds, ends], axis=-1)
    # In the upper tail both ends are mirrored: differences of numbers near 1 would lose their digits.
    mirrored = low + high > 0
    low, high = np.where(mirrored, -high, low), np.where(mirrored, -low, high)
    with np.errstate(divide="ignore", invalid="ignore"):
        log_high, log_low = log_ndtr(high), log_ndtr(low)
        found = log_high + np.log1p(-np.exp(np.minimum(log_low - log_high, 0.0)))
    return np.where(log_high == -np.inf, -np.inf, found)


def fit_ordered_normals(counts: Array, cuts: Array | None, shrinkage: float) -> OrderedNormals:
    """Means, deviations and cut points of the greatest penalised likelihood.

    Parameters
    ----------
    counts : (n_types, n_policies, n_categories) float
        Number of samples, at least one of each pair, at least two categories.
    cuts : (n_categories - 1,) float, optional
        Known cut points; means and deviations are then in their unit. By default they are fitted.
    shrinkage : float
        Number of samples of weight of the common deviation in each pair's deviation, above 0.
    """
    spacing = None if cuts is None else np.diff(cuts)
    mean, log_deviation, places = _unpacked(_minimum(counts, spacing, shrinkage), counts.shape, spacing)
    deviation = np.exp(log_deviation)
    deviation = np.sqrt(deviation**2 + 1 / _information(mean, deviation, places, counts))
    if cuts is None or spacing is None:
        return OrderedNormals(mean, deviation, places)
    # One unit of the caller in common deviations; with a single cut point there is no scale, and the unit is 1.
    unit = places[-1] / (cuts[-1] - cuts[0]) if spacing.size else 1.0
    return OrderedNormals(mean / unit + cuts[0], deviation / unit, cuts)


def _minimum(counts: Array, spacing: Array | None, shrinkage: float) -> Array:
    """The numbers of the least `_penalised`, searched in steps of about their standard errors."""
    from scipy.optimize import minimize

    start, n = _start(counts, spacing), counts.sum(axis=2).ravel()
    common = np.full(start.size - 2 * n.size, n.sum() + 1)
    steps = 1 / np.sqrt(np.concatenate([n + 1, 2 * (n + shrinkage), common]))

    def objective(y: Array) -> tuple[float, Array]:
        value, gradient = _penalised(start + steps * y, counts, spacing, shrinkage)
        return value, gradient * steps

    logarithms = (np.arange(start.size) >= n.size) & (spacing is None or np.arange(start.size) < 2 * n.size)
    ends = np.where(logarithms, LOG_LIMIT, np.inf)
    limits = np.stack([(-ends - start) / steps, (ends - start) / steps], axis=1)
    found = minimize(objective, np.zeros(start.size), method="L-BFGS-B", jac=True, bounds=limits, options=SEARCH)
    return start + steps * found.x


def _start(counts: Array, spacing: Array | None) -> Array:
    """Starting values from the shares of all pairs together and each pair's mean place among the cut points."""
    from scipy.special import ndtri

    shares = counts.sum(axis=(0, 1)) + UNSEEN
    places = 2.0 * ndtri(np.cumsum(shares)[:-1] / shares.sum())
    gaps = np.maximum(np.diff(places), 0.05)
    if spacing is None:
        scale = np.log(gaps)
    else:
        scale = np.log([gaps.sum() / spacing.sum()]) if spacing.size else np.empty(0)
    inner = np.concatenate([[0.0], np.cumsum(gaps)])
    middles = np.concatenate([[inner[0] - 1], 0.5 * (inner[1:] + inner[:-1]), [inner[-1] + 1]])
    mean = (counts * middles).sum(axis=2) / counts.sum(axis=2)
    return np.concatenate([mean.ravel(), np.zeros(mean.size), scale])


def _unpacked(x: Array, shape: tuple[int, ...], spacing: Array | None) -> tuple[Array, Array, Array]:
    """Means, log deviations (n_types, n_policies) and cut points of which the first is 0."""
    n = shape[0] * shape[1]
    mean, log_deviation = x[:n].reshape(shape[:2]), x[n : 2 * n].reshape(shape[:2])
    gaps = np.exp(x[2 * n :]) if spacing is None else np.exp(x[2 * n :].sum()) * spacing
    return mean, log_deviation, np.concatenate([[0.0], np.cumsum(gaps)])


def _penalised(x: Array, counts: Array, spacing: Array | None, shrinkage: float) -> tuple[float, Array]:
    """Minus the penalised log likelihood, and its gradient."""
    from scipy.special import logsumexp

    mean, log_deviation, cuts = _unpacked(x, counts.shape, spacing)
    deviation = np.exp(log_deviation)
    log_probs = log_probabilities(mean, deviation, cuts)
    log_pooled = logsumexp(log_probs, axis=(0, 1)) - np.log(mean.size)
    value = (counts * log_probs).sum() + UNSEEN * log_pooled.sum()
    # dP_k = φ(z_k) dz_k - φ(z_{k-1}) dz_{k-1}: a bound gives to the category below what it takes from that above.
    # Densities are divided by probabilities as logarithms, because both may be too small for numbers.
    bounds = (cuts - mean[..., None]) / deviation[..., None]
    log_density = -0.5 * bounds**2 - 0.5 * np.log(2 * np.pi)
    flow = counts[..., :-1] * np.exp(log_density - log_probs[..., :-1])
    flow -= counts[..., 1:] * np.exp(log_density - log_probs[..., 1:])
    flow += UNSEEN / mean.size * np.exp(log_density - log_pooled[:-1])
    flow -= UNSEEN / mean.size * np.exp(log_density - log_pooled[1:])
    of_mean = -(flow / deviation[..., None]).sum(axis=2)
    of_log_deviation = -(flow * bounds).sum(axis=2)
    of_cuts = (flow / deviation[..., None]).sum(axis=(0, 1))
    # Deviations are near 1. The information of a sample about a log deviation is 2.
    value -= shrinkage * (log_deviation**2).sum()
    of_log_deviation -= 2 * shrinkage * log_deviation
    # Means lie within the range of the cut points: a normal about its middle, whose deviation is the range.
    middle, square = 0.5 * cuts[-1], LEAST_RANGE**2 + cuts[-1] ** 2
    away = mean - middle
    value -= 0.5 * (away**2).sum() / square + 0.5 * mean.size * np.log(square)
    of_mean -= away / square
    of_cuts[-1] += (
        0.5 * away.sum() / square + cuts[-1] * (away**2).sum() / square**2 - mean.size * cuts[-1] / square
    )
    of_gaps = np.cumsum(of_cuts[::-1])[::-1][1:] * np.diff(cuts)
    of_scale = of_gaps if spacing is None else of_gaps.sum(keepdims=True) if spacing.size else np.empty(0)
    return -value, -np.concatenate([of_mean.ravel(), of_log_deviation.ravel(), of_scale])


def _information(mean: Array, deviation: Array, cuts: Array, counts: Array) -> Array:
    """Expected information about each mean in its samples and the prior, (n_types, n_policies)."""
    probs = np.maximum(np.exp(log_probabilities(mean, deviation, cuts)), 1e-12)
    bounds = (cuts - mean[..., None]) / deviation[..., None]
    density = np.exp(-0.5 * bounds**2) / np.sqrt(2 * np.pi) / deviation[..., None]
    ends = np.zeros((*mean.shape, 1))
    slope = np.concatenate([ends, density], axis=-1) - np.concatenate([density, ends], axis=-1)
    return counts.sum(axis=2) * (slope**2 / probs).sum(axis=2) + 1 / (LEAST_RANGE**2 + cuts[-1] ** 2)
