"""Feet of objects: points within the band of the table's noise that belong to what stands there."""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE

_ABOVE = 0.35
"""Part of the band's half width above which a point may be a foot; most of the table's own points lie below."""
_NEAR = 0.9
"""Half widths of the band within which a point of the object must be."""
_LOW = 3.0
"""Half widths of the band up to which the points of an object are looked at."""


def with_feet(
    labels: NDArray[np.int64], points: NDArray[np.float64], bands: NDArray[np.float64]
) -> NDArray[np.int64]:
    """(n,) labels in which the feet of objects are theirs.

    A band as wide as the noise takes the lowest centimetre of each object for the table. Points in its upper part
    that are near to an object are given to it.

    Parameters
    ----------
    labels : (n,) int64
        As in `LabelledCloud`.
    points : (n, 3) float64
        In the scene's frame, metres.
    bands : (n,) float64
        Half width of the table's band at each point, metres (`range_noise.band`).
    """
    from scipy.spatial import KDTree

    heights = points[:, 2]
    low = np.flatnonzero((labels > TABLE) & (heights < _LOW * bands))
    feet = np.flatnonzero((labels <= TABLE) & (heights > _ABOVE * bands) & (heights <= bands))
    if len(low) == 0 or len(feet) == 0:
        return labels
    widest = _NEAR * float(bands[low].max())
    feet = feet[_beside(points[feet, :2], points[low, :2], widest)]
    distance, nearest = KDTree(points[low]).query(points[feet], distance_upper_bound=widest)
    near = distance <= _NEAR * bands[feet]
    labels = labels.copy()
    labels[feet[near]] = labels[low[np.asarray(nearest)[near]]]
    return labels


def _beside(points: NDArray[np.float64], others: NDArray[np.float64], distance: float) -> NDArray[np.bool_]:
    """(n,) bool: points (n, 2) in a cell of side `distance` with one of `others` (m, 2), or beside such a cell."""
    corner = np.minimum(points.min(axis=0, initial=np.inf), others.min(axis=0)) - 2 * distance
    cells, filled = (np.floor((places - corner) / distance).astype(np.int64) for places in (points, others))
    grid = np.zeros(np.maximum(cells.max(axis=0, initial=0), filled.max(axis=0)) + 2, bool)
    for x in (-1, 0, 1):
        for y in (-1, 0, 1):
            grid[tuple((filled + np.array([x, y])).T)] = True
    return grid[tuple(cells.T)]
