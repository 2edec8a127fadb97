"""k-nearest neighbours on the displacement of the closest points: contact without a separator."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from lifelore.perception.peers.pair_classifier import PairClassifier, neighbours
from lifelore.perception.peers.peer import SETTINGS

SHARE = 0.01
"""Share of the smaller object's points that are averaged: a single pair has the noise of one camera pixel."""


def closest_displacement(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean displacement from `second` to `first` over the closest pairs of points, shape ``(3,)``, metres."""
    if len(first) > len(second):
        return -closest_displacement(second, first)
    distance, nearest = _nearest(first, second)
    closest = np.argsort(distance, kind="stable")[: max(1, round(SHARE * len(first)))]
    closest = closest[np.isfinite(distance[closest])]
    return (first[closest] - second[nearest[closest]]).mean(axis=0)


def _nearest(first: NDArray[np.float64], second: NDArray[np.float64]) -> tuple[NDArray, NDArray]:
    """Distance and index of the nearest point of `second`, within a bound that finds at least one."""
    bound, tree = 2 * SETTINGS.near, KDTree(second)
    while True:
        found = tree.query(first, distance_upper_bound=bound)
        distance, nearest = np.asarray(found[0]), np.asarray(found[1])
        if np.isfinite(distance).any():
            return distance, nearest
        bound *= 2


def closest_point() -> PairClassifier:
    """A classifier on the displacement of the closest points alone."""
    return PairClassifier(closest_displacement, neighbours)
