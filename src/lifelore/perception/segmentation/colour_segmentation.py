"""Segmentation by colour: clusters of a colour histogram, the thesis's method.

The colours are normalised by their brightness, counted in a three-dimensional histogram, and the occupied
bins are clustered by k-means, each weighing as much as the points in it. With k = 3 the smallest cluster is
the background and the other two are the objects; with a larger k the clusters below a size are noise. Points
that were misjudged are cleaned up by the vote of their nearest neighbours in space. It works where the objects
differ in hue; grey, black and white are one colour to it.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import UNLABELLED
from lifelore.core.streams import stream

BINS = 32
NEIGHBOURS = 15
_VOTERS = 100_000


def colour_classes(
    points: NDArray[np.float64],
    colours: NDArray[np.uint8],
    k: int = 3,
    min_share: float = 0.05,
    neighbours: int = NEIGHBOURS,
) -> NDArray[np.int64]:
    """Label points by colour (thesis §2.3.3).

    Parameters
    ----------
    points : (n, 3) metres
        Points above the table.
    colours : (n, 3) uint8
    k : int
        Clusters, ≥ 2. Up to 3, the smallest is the background; above, all below `min_share` are noise.
    min_share : float
        Share of the points, in 0–1.
    neighbours : int
        Neighbours in the vote that corrects points; 1 changes none.

    Returns
    -------
    (n,) int64
        2 the largest cluster of colour, 3 the next, …; 0 background and noise.

    Raises
    ------
    InputError
        The points show fewer colours than `k`.
    """
    if len(points) == 0:
        return np.empty(0, np.int64)
    cluster = _clusters_of_bins(normalised(colours), k)
    sizes = np.bincount(cluster, minlength=k)
    order = np.argsort(-sizes, kind="stable")
    kept = order[:-1] if k <= 3 else order[sizes[order] >= min_share * len(points)]
    label = np.full(k, UNLABELLED, np.int64)
    label[kept] = np.arange(2, 2 + len(kept))
    return _cleaned(points, label[cluster], neighbours)


def normalised(colours: NDArray[np.uint8]) -> NDArray[np.float64]:
    """(n, 3) shares of red, green and blue, which sum to 1; black counts as grey."""
    wide = colours.astype(np.float64)
    total = wide.sum(axis=1, keepdims=True)
    return np.divide(wide, total, out=np.full_like(wide, 1 / 3), where=total > 0)


def _clusters_of_bins(shares: NDArray[np.float64], k: int) -> NDArray[np.int64]:
    from sklearn.cluster import KMeans

    cells = np.minimum((shares * BINS).astype(np.int64), BINS - 1)
    bins, bin_of, counts = np.unique(
        np.ravel_multi_index(tuple(cells.T), (BINS,) * 3), return_inverse=True, return_counts=True
    )
    if len(bins) < k:
        raise InputError(f"the points show {len(bins)} colours where {k} are asked for; use method=convexity")
    centres = np.stack(np.unravel_index(bins, (BINS,) * 3), axis=1) + 0.5
    seed = int(stream(0, "perception", "colour bins").integers(2**31))
    means = KMeans(k, n_init=10, random_state=seed)  # type: ignore[arg-type]  its hints forget the number
    found = means.fit_predict(centres, sample_weight=counts.astype(np.float64))
    return found[bin_of.reshape(-1)].astype(np.int64)


def _cleaned(points: NDArray[np.float64], labels: NDArray[np.int64], neighbours: int) -> NDArray[np.int64]:
    from sklearn.neighbors import KNeighborsClassifier

    voters = slice(None, None, max(1, len(points) // _VOTERS))
    vote = KNeighborsClassifier(min(neighbours, len(points[voters])))
    return vote.fit(points[voters], labels[voters]).predict(points).astype(np.int64)
