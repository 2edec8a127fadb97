"""Angles about gravity and distances in the style of Mees et al. (IROS 2017): 36 bins of angle, 3 of distance.

For every point p of one object, with r = p - centroid, and every point q of the other, with d = q - p: the angle
between r and d (18 bins), and that between the planes (r, gravity) and (d, r) (18 bins). Of the distances |d| the
nearest hundredth is counted up to 6 cm, up to 20 cm, and beyond. The paper learns a metric with large margins;
here a support vector classifier weighs the bins.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.peers.pair_classifier import PairClassifier
from lifelore.perception.peers.peer import mean_of_voxels

GRAIN = 0.015
"""Side of the voxels in metres; the paper uses 1 to 3 cm."""
ANGLE_BINS = 18
DISTANCE_EDGES = np.array([0.06, 0.20])
NEAREST = 0.01
GRAVITY = np.array([0.0, 0.0, -1.0])


def angle_distance_histogram(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Three histograms in one vector, shape ``(39,)``; each sums to 1."""
    points, others = mean_of_voxels(first, GRAIN), mean_of_voxels(second, GRAIN)
    reference = points - points.mean(axis=0)
    offset = others[None] - points[:, None]
    reference_all = np.broadcast_to(reference[:, None], offset.shape)
    planes = np.cross(reference, GRAVITY)[:, None], np.cross(offset, reference_all)
    distance = np.sort(np.linalg.norm(offset, axis=-1).ravel())[: max(1, int(NEAREST * offset[..., 0].size))]
    near = np.bincount(np.searchsorted(DISTANCE_EDGES, distance), minlength=3) / len(distance)
    return np.concatenate([_angles(reference_all, offset), _angles(*planes), near])


def _angles(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Shares of the angles between vectors, ``(ANGLE_BINS,)`` over [0, π]; a vector of length 0 counts as a right
    angle."""
    lengths = np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1)
    cosine = np.clip((first * second).sum(axis=-1) / np.maximum(lengths, 1e-12), -1, 1)
    bins = np.minimum((np.arccos(cosine) / np.pi * ANGLE_BINS).astype(np.int64), ANGLE_BINS - 1)
    return np.bincount(bins.ravel(), minlength=ANGLE_BINS) / bins.size


def angle_distance_machine(seed: int = 0) -> PairClassifier:
    """A classifier on the three histograms alone."""

    def estimator(n_rows: int) -> Any:
        from sklearn.pipeline import make_pipeline
        from sklearn.preprocessing import StandardScaler
        from sklearn.svm import SVC

        return make_pipeline(StandardScaler(), SVC(C=10.0))

    return PairClassifier(angle_distance_histogram, estimator)
