"""Faults put into clouds on purpose: fewer points, noisier depth, wrong labels, an object segmented into two.

Each function takes a `LabelledCloud` and returns a new cloud with the same camera. Thesis: §2.4.1 discards points,
Figs 2.7 and 2.9 show wrong segmentations.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import KDTree

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud

BORDER = 0.005


def fewer_points(cloud: LabelledCloud, discarded: float, rng: np.random.Generator) -> LabelledCloud:
    """Each point discarded with probability `discarded`, in [0, 1)."""
    if not 0 <= discarded < 1:
        raise InputError(f"discarded must lie in [0, 1), got {discarded}")
    kept = rng.random(len(cloud.points)) >= discarded
    colours = None if cloud.colours is None else cloud.colours[kept]
    return LabelledCloud(cloud.points[kept], cloud.labels[kept], colours, cloud.camera)


def noisier_depth(cloud: LabelledCloud, deviation: float, rng: np.random.Generator) -> LabelledCloud:
    """Each point moved along its line of sight by a normal error.

    Parameters
    ----------
    deviation : float
        Standard deviation, metres, ≥ 0.

    Raises
    ------
    InputError
        The cloud's camera is unknown, or `deviation` is negative.
    """
    if cloud.camera is None:
        raise InputError("cloud must know its camera for noise along the line of sight; give camera")
    if deviation < 0:
        raise InputError(f"deviation must be at least 0, got {deviation}")
    sight = cloud.points - cloud.camera
    sight = sight / np.maximum(np.linalg.norm(sight, axis=1, keepdims=True), 1e-12)
    error = rng.normal(0, deviation, len(cloud.points))
    return LabelledCloud(cloud.points + error[:, None] * sight, cloud.labels, cloud.colours, cloud.camera)


def swapped_border(
    cloud: LabelledCloud, rng: np.random.Generator, width: float = BORDER, probability: float = 0.5
) -> LabelledCloud:
    """Each point within `width` metres of another object takes that object's label with `probability`.

    The table keeps its points and is given none: an object's foot would otherwise become table all around it.
    """
    distance, other = _nearest_other(cloud, width)
    swapped = (distance <= width) & (rng.random(len(cloud.points)) < probability)
    labels = np.where(swapped, other, cloud.labels)
    return LabelledCloud(cloud.points, labels, cloud.colours, cloud.camera)


def grown_masks(cloud: LabelledCloud, rng: np.random.Generator, width: float = BORDER) -> LabelledCloud:
    """Objects in a random order: each grows by `width` metres over those that come after it, and over the table.

    A point is taken at most once.
    """
    labels = cloud.labels.copy()
    free = cloud.labels >= TABLE
    for label in rng.permutation(cloud.objects).tolist():
        free &= cloud.labels != label
        asking = np.flatnonzero(free)
        distance, _ = KDTree(cloud.of(label)).query(cloud.points[asking], distance_upper_bound=width)
        near = asking[np.isfinite(distance)]
        labels[near], free[near] = label, False
    return LabelledCloud(cloud.points, labels, cloud.colours, cloud.camera)


def cut_object(
    cloud: LabelledCloud, label: int, normal: ArrayLike, through: ArrayLike
) -> tuple[LabelledCloud, int]:
    """The cloud with an object divided by a plane, and the new label: of the part that `normal` points to.

    Raises
    ------
    InputError
        The cloud has no such object, or the plane leaves one side empty.
    """
    own = (cloud.labels == label) & (cloud.labels > TABLE)
    beyond = own & ((cloud.points - np.asarray(through, float)) @ np.asarray(normal, float) > 0)
    if not beyond.any() or beyond.sum() == own.sum():
        raise InputError(
            f"the plane must divide object {label}, which has {own.sum()} points, {beyond.sum()} of them beyond it"
        )
    new = int(cloud.labels.max()) + 1
    labels = np.where(beyond, new, cloud.labels)
    return LabelledCloud(cloud.points, labels, cloud.colours, cloud.camera), new


def _nearest_other(cloud: LabelledCloud, width: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Distance (infinite beyond `width`) to the nearest point of another object, and that object."""
    best = np.full(len(cloud.points), np.inf)
    other = cloud.labels.copy()
    for label in cloud.objects:
        asking = np.flatnonzero((cloud.labels != label) & (cloud.labels > TABLE))
        found = KDTree(cloud.of(label)).query(cloud.points[asking], distance_upper_bound=width)
        distance = np.asarray(found[0])
        nearer = asking[distance < best[asking]]
        best[nearer], other[nearer] = distance[distance < best[asking]], label
    return best, other
