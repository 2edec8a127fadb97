"""Histograms over all pairs of points in the style of Fichtl et al. (ICRA 2014), read by randomised trees.

For every point of one object and every point of the other: the elevation of their displacement over the
horizontal, and its length; counted in two dimensions. Heading is left out, so a turned table changes nothing.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from reproduction.own.o_07_unseen_scenes.peers.pair_classifier import PairClassifier
from reproduction.own.o_07_unseen_scenes.peers.peer import mean_of_voxels

GRAIN = 0.015
"""Side of the voxels in metres; clouds are thinned first, since all pairs of points are counted."""
ELEVATION_BINS = 12
DISTANCE_EDGES = np.array([0.0, 0.02, 0.04, 0.07, 0.11, 0.16, 0.23, 0.32, np.inf])
"""Metres, finer where objects meet."""
TREES = 100


def orientation_histogram(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Shares of point pairs by elevation and distance, flat ``(ELEVATION_BINS * 8,)``, sums to 1."""
    offset = mean_of_voxels(first, GRAIN)[:, None] - mean_of_voxels(second, GRAIN)[None]
    distance = np.linalg.norm(offset, axis=-1).ravel()
    elevation = np.arcsin(np.clip(offset[..., 2].ravel() / np.maximum(distance, 1e-12), -1, 1))
    row = np.clip(((elevation / np.pi + 0.5) * ELEVATION_BINS).astype(np.int64), 0, ELEVATION_BINS - 1)
    column = np.searchsorted(DISTANCE_EDGES, distance, side="right") - 1
    bins = len(DISTANCE_EDGES) - 1
    count = np.bincount(row * bins + column, minlength=ELEVATION_BINS * bins)
    return count / count.sum()


def orientation_trees(seed: int = 0) -> PairClassifier:
    """A classifier on the two-dimensional histogram alone."""

    def estimator() -> Any:
        from sklearn.ensemble import ExtraTreesClassifier

        return ExtraTreesClassifier(TREES, random_state=seed)

    return PairClassifier(orientation_histogram, estimator)
