"""Estimates of claims with 95 % intervals: exact shares, means by cluster, quantiles, shares of a grid."""

from collections.abc import Collection, Hashable, Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.stats import beta, binom

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate

UNMEASURED = Estimate(float("nan"), float("nan"), None, 0)
"""What a run that lacks its scenes says of them."""


def exact_share(answers: Iterable[bool]) -> Estimate:
    """Share of true answers, each of a scene of its own; `UNMEASURED` of none."""
    given = [bool(answer) for answer in answers]
    n, right = len(given), sum(given)
    if not n:
        return UNMEASURED
    low = float(beta.ppf(0.025, right, n - right + 1)) if right else 0.0
    high = float(beta.ppf(0.975, right + 1, n - right)) if right < n else 1.0
    return Estimate(right / n, float(2 * right > n) if 2 * right != n else 0.5, (low, high), n)


def mean_by_cluster(values: Collection[float], clusters: Collection[Hashable]) -> Estimate:
    """Mean of values with an interval that resamples clusters; `n` counts clusters."""
    order = {name: number for number, name in enumerate(dict.fromkeys(clusters))}
    at = np.array([order[name] for name in clusters])
    sums = np.bincount(at, np.asarray(values, float), len(order))
    return ratio_estimate(sums, np.bincount(at, minlength=len(order)).astype(float))


def share_by_cluster(answers: Collection[bool], clusters: Collection[Hashable]) -> Estimate:
    """Share of true answers, clusters resampled; the exact interval where no resample differs."""
    exact = exact_share(answers)
    if not exact.n:
        return UNMEASURED
    found = mean_by_cluster(answers, clusters)
    spread = found.ci95 if found.ci95 and found.ci95[0] < found.ci95[1] else exact.ci95
    return replace(found, ci95=spread, n=exact.n)


def mean_or_unmeasured(values: Iterable[float]) -> Estimate:
    """Mean with its bootstrap interval; `UNMEASURED` of no values."""
    given = list(values)
    return mean_estimate(given) if given else UNMEASURED


def ratio_or_unmeasured(parts: ArrayLike, wholes: ArrayLike) -> Estimate:
    """Ratio of sums over the scenes that have something to divide by; `UNMEASURED` where none has."""
    parts, wholes = np.asarray(parts, float), np.asarray(wholes, float)
    some = wholes > 0
    return ratio_estimate(parts[some], wholes[some]) if some.any() else UNMEASURED


def quantile_estimate(values: NDArray[np.float64], q: float) -> Estimate:
    """A quantile with its distribution-free 95 % interval: order statistics at binomial ranks."""
    n = len(values)
    low, high = binom.ppf([0.025, 0.975], n, q).astype(int)
    ordered = np.sort(values)
    ends = (float(ordered[max(low - 1, 0)]), float(ordered[min(high, n - 1)]))
    return Estimate(float(np.quantile(values, q)), float(np.median(values)), ends if n >= 3 else None, n)


def share_of(cells: ArrayLike) -> Estimate:
    """The share of true `cells` (n,); a count of all there are, so without an interval."""
    cells = np.asarray(cells, float)
    return Estimate(float(cells.mean()), float(np.median(cells)), None, len(cells))


def exact_value(value: float, n: int = 1) -> Estimate:
    """A number without sampling error, computed from `n` values; no interval."""
    return Estimate(float(value), float(value), None, n)
