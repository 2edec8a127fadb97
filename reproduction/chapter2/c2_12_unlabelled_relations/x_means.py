"""X-means: k-means that finds its number of clusters by splits that improve the Bayesian criterion.

Pelleg and Moore, "X-means: extending k-means with efficient estimation of the number of clusters", ICML 2000; the
thesis proposes it to find relations without labels (§2.3.5). Their printed likelihood has three errors (erratum
E21); `bayesian_criterion` is the corrected one.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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


def x_means(points: NDArray[np.float64], rng: np.random.Generator, most: int = 20) -> Clustering:
    """Cluster points (n, d); the number of clusters is found, at most `most`.

    From one centre: improve the centres (k-means to convergence); split each in two along a random direction,
    2-means within its region, and keep the halves where their criterion on the region's points is the larger; and
    again, until nothing splits or there are `most`. The best model met on the way is the answer.
    """
    best = model = _improved(points, points.mean(axis=0, keepdims=True))
    while len(model.centres) < most:
        centres = _split_centres(points, model, most, rng)
        if len(centres) == len(model.centres):
            break
        model = _improved(points, centres)
        best = max(best, model, key=lambda one: one.criterion)
    return best


def bayesian_criterion(
    points: NDArray[np.float64], centres: NDArray[np.float64], labels: NDArray[np.int64]
) -> float:
    """log likelihood - p/2 · log R of spherical Gaussians of one variance, p = (K - 1) + M·K + 1.

    R points in M dimensions, R_n of them in cluster n, S the sum of squared distances to the centres:
    σ² = S / (M·R), and l = Σ R_n log(R_n / R) - R·M/2 · (log 2πσ² + 1).
    """
    n, dimensions = points.shape
    k = len(centres)
    sizes = np.bincount(labels, minlength=k)
    squares = float(((points - centres[labels]) ** 2).sum())
    mixing = float((sizes * np.log(np.maximum(sizes, 1) / n)).sum())
    variance = max(squares / (dimensions * n), _TINY)
    fit = mixing - n * dimensions / 2 * (np.log(2 * np.pi * variance) + 1)
    return float(fit - ((k - 1) + dimensions * k + 1) / 2 * np.log(n))


def _improved(points: NDArray[np.float64], centres: NDArray[np.float64]) -> Clustering:
    """k-means to convergence from `centres`; centres without points are dropped."""
    labels = np.full(len(points), -1)
    while True:
        nearest = ((points[:, None] - centres[None]) ** 2).sum(axis=-1).argmin(axis=1)
        if (nearest == labels).all():
            break
        _, labels = np.unique(nearest, return_inverse=True)
        centres = np.array([points[labels == number].mean(axis=0) for number in range(labels.max() + 1)])
    return Clustering(centres, labels.astype(np.int64), bayesian_criterion(points, centres, labels))


def _split_centres(
    points: NDArray[np.float64], model: Clustering, most: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Each centre, or its two halves where the criterion prefers them; the best gains first, at most `most`."""
    gains, halves = [], []
    for number, centre in enumerate(model.centres):
        region = points[model.labels == number]
        # Drawn for every centre, so that a split of one does not change the draws of others.
        direction = rng.normal(size=points.shape[1])
        split = _halved(region, centre, direction)
        whole = bayesian_criterion(region, centre[None], np.zeros(len(region), np.int64))
        gains.append(split.criterion - whole if split else -np.inf)
        halves.append(split.centres if split else centre[None])
    room = most - len(model.centres)
    chosen = {int(at) for at in np.argsort(gains)[::-1][:room] if gains[at] > 0}
    return np.concatenate(
        [halves[at] if at in chosen else model.centres[at][None] for at in range(len(model.centres))]
    )


def _halved(
    region: NDArray[np.float64], centre: NDArray[np.float64], direction: NDArray[np.float64]
) -> Clustering | None:
    """2-means of a region from either side of its centre, as far out as the region reaches."""
    if len(region) < 3 or (region == region[0]).all():
        return None
    reach = np.sqrt(((region - centre) ** 2).sum(axis=1).mean()) * direction / np.linalg.norm(direction)
    split = _improved(region, np.stack([centre + reach, centre - reach]))
    return split if len(split.centres) == 2 else None
