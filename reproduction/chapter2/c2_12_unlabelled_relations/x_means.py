"""X-means: k-means that finds its number of clusters by splits that improve the Bayesian criterion.

Pelleg and Moore, "X-means: extending k-means with efficient estimation of the number of clusters", ICML 2000; the
thesis proposes it to find relations without labels (§2.3.5). Their printed likelihood has three errors, see
`bayesian_criterion`; the corrected one is the default.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError

Formula = Literal["corrected", "printed"]
_TINY = 1e-12


@dataclass(frozen=True, eq=False)
class Clustering:
    """Points in clusters.

    Parameters
    ----------
    centres : (k, d) float64
    labels : (n,) int64
        In 0 … k - 1; every cluster has a point.
    criterion : float
        The Bayesian information criterion, larger is better.
    """

    centres: NDArray[np.float64]
    labels: NDArray[np.int64]
    criterion: float


def x_means(
    points: NDArray[np.float64],
    rng: np.random.Generator,
    *,
    least: int = 1,
    most: int = 20,
    formula: Formula = "corrected",
) -> Clustering:
    """Cluster points; the number of clusters is found.

    From `least` centres: improve the centres (k-means to convergence); split each in two along a random direction,
    2-means within its region, and keep the halves where their criterion on the region's points is the larger; and
    again, until nothing splits or there are `most`. The best model met on the way is the answer.

    Parameters
    ----------
    points : (n, d) float64
        Finite.
    rng : numpy Generator
    least, most : int
        1 ≤ least ≤ most ≤ n.
    formula : {"corrected", "printed"}
        See `bayesian_criterion`.

    Raises
    ------
    InputError
        An argument breaks its rule.
    """
    points = _checked(points, least, most)
    model = _improved(points, _first_centres(points, least, rng), formula)
    best = model
    while len(model.centres) < most:
        centres = _split_centres(points, model, most, formula, rng)
        if len(centres) == len(model.centres):
            break
        model = _improved(points, centres, formula)
        best = max(best, model, key=lambda one: one.criterion)
    return best


def bayesian_criterion(
    points: NDArray[np.float64],
    centres: NDArray[np.float64],
    labels: NDArray[np.int64],
    formula: Formula = "corrected",
) -> float:
    """log likelihood - p/2 · log R of spherical Gaussians of one variance, p = (K - 1) + M·K + 1.

    R points in M dimensions, R_n of them in cluster n, S the sum of squared distances to the centres.

    *corrected*: σ² = S / (M·R), and l = Σ R_n log(R_n / R) - R·M/2 · (log 2πσ² + 1).

    *printed* (their §3.2): σ² = S / (R - K), and l = Σ_n [-R_n/2 · log 2π - R_n·M/2 · log σ² - (R_n - K)/2
    + R_n log R_n - R_n log R]. There S / (R - K) estimates M·σ², the variance of one coordinate times M; the
    density has the factor (2π)^(-1/2) where M dimensions have (2π)^(-M/2); and (R_n - K)/2 sums to (R - K²)/2,
    where their own variance gives (R - K)/2.
    """
    n, dimensions = points.shape
    k = len(centres)
    sizes = np.bincount(labels, minlength=k)
    squares = float(((points - centres[labels]) ** 2).sum())
    mixing = float((sizes * np.log(np.maximum(sizes, 1) / n)).sum())
    if formula == "corrected":
        variance = max(squares / (dimensions * n), _TINY)
        fit = mixing - n * dimensions / 2 * (np.log(2 * np.pi * variance) + 1)
    else:
        variance = max(squares / max(n - k, 1), _TINY)
        fit = mixing - n / 2 * np.log(2 * np.pi) - n * dimensions / 2 * np.log(variance) - (n - k * k) / 2
    return float(fit - ((k - 1) + dimensions * k + 1) / 2 * np.log(n))


def _checked(points: NDArray[np.float64], least: int, most: int) -> NDArray[np.float64]:
    points = np.asarray(points, np.float64)
    if points.ndim != 2 or not points.size or not np.isfinite(points).all():
        raise InputError(f"points must be finite and of shape (n, d), got shape {points.shape}")
    if not 1 <= least <= most <= len(points):
        raise InputError(f"least and most must keep 1 <= least <= most <= {len(points)}, got {least} and {most}")
    return points


def _first_centres(points: NDArray[np.float64], k: int, rng: np.random.Generator) -> NDArray[np.float64]:
    if k == 1:
        return points.mean(axis=0, keepdims=True)
    from sklearn.cluster import kmeans_plusplus

    return kmeans_plusplus(points, k, random_state=int(rng.integers(2**31)))[0]


def _improved(points: NDArray[np.float64], centres: NDArray[np.float64], formula: Formula) -> Clustering:
    """k-means to convergence from `centres`; centres without points are dropped."""
    labels = np.full(len(points), -1)
    while True:
        nearest = ((points[:, None] - centres[None]) ** 2).sum(axis=-1).argmin(axis=1)
        if (nearest == labels).all():
            break
        _, labels = np.unique(nearest, return_inverse=True)
        centres = np.array([points[labels == number].mean(axis=0) for number in range(labels.max() + 1)])
    return Clustering(centres, labels.astype(np.int64), bayesian_criterion(points, centres, labels, formula))


def _split_centres(
    points: NDArray[np.float64], model: Clustering, most: int, formula: Formula, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Each centre, or its two halves where the criterion prefers them; the best gains first, at most `most`."""
    gains, halves = [], []
    for number, centre in enumerate(model.centres):
        region = points[model.labels == number]
        # Drawn for every centre, so that a split of one does not change the draws of others.
        direction = rng.normal(size=points.shape[1])
        split = _halved(region, centre, direction, formula)
        whole = bayesian_criterion(region, centre[None], np.zeros(len(region), np.int64), formula)
        gains.append(split.criterion - whole if split else -np.inf)
        halves.append(split.centres if split else centre[None])
    room = most - len(model.centres)
    chosen = {int(at) for at in np.argsort(gains)[::-1][:room] if gains[at] > 0}
    return np.concatenate(
        [halves[at] if at in chosen else model.centres[at][None] for at in range(len(model.centres))]
    )


def _halved(
    region: NDArray[np.float64], centre: NDArray[np.float64], direction: NDArray[np.float64], formula: Formula
) -> Clustering | None:
    """2-means of a region from either side of its centre, as far out as the region reaches."""
    if len(region) < 3 or (region == region[0]).all():
        return None
    reach = np.sqrt(((region - centre) ** 2).sum(axis=1).mean()) * direction / np.linalg.norm(direction)
    split = _improved(region, np.stack([centre + reach, centre - reach]), formula)
    return split if len(split.centres) == 2 else None
