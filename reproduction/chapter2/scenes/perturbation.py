"""Clouds changed on purpose: parts of a cloud, noisier depth, wrong labels, an object segmented into two.

Each function takes a `LabelledCloud` and returns a new cloud with the same camera. Thesis: §2.4.1 discards points,
Figs 2.7 and 2.9 show wrong segmentations.
"""

from collections.abc import Collection
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import KDTree

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud

BORDER = 0.005
"""Metres."""


def part_of(cloud: LabelledCloud, kept: NDArray[np.bool_]) -> LabelledCloud:
    """The points where `kept` ``(n,)`` is true."""
    colours = None if cloud.colours is None else cloud.colours[kept]
    return LabelledCloud(cloud.points[kept], cloud.labels[kept], colours, cloud.camera)


def only(cloud: LabelledCloud, objects: Collection[int]) -> LabelledCloud:
    """The cloud of some objects and the table."""
    return part_of(cloud, np.isin(cloud.labels, [TABLE, *objects]))


def without_table(cloud: LabelledCloud) -> LabelledCloud:
    """The points of the objects alone."""
    return part_of(cloud, cloud.labels > TABLE)


def fewer_points(cloud: LabelledCloud, discarded: float, rng: np.random.Generator) -> LabelledCloud:
    """Each point discarded with probability `discarded`, in [0, 1)."""
    if not 0 <= discarded < 1:
        raise InputError(f"discarded must lie in [0, 1), got {discarded}")
    return part_of(cloud, rng.random(len(cloud.points)) >= discarded)


def noisier_depth(cloud: LabelledCloud, deviation: float, rng: np.random.Generator) -> LabelledCloud:
    """Each point moved along its line of sight by a normal error of `deviation` metres, at least 0."""
    if cloud.camera is None:
        raise InputError("cloud must know its camera for noise along the line of sight; give camera")
    if deviation < 0:
        raise InputError(f"deviation must be at least 0, got {deviation}")
    sight = cloud.points - cloud.camera
    sight = sight / np.maximum(np.linalg.norm(sight, axis=1, keepdims=True), 1e-12)
    error = rng.normal(0, deviation, len(cloud.points))
    return replace(cloud, points=cloud.points + error[:, None] * sight)


def swapped_border(
    cloud: LabelledCloud, rng: np.random.Generator, width: float = BORDER, probability: float = 0.5
) -> LabelledCloud:
    """Each point within `width` metres of another object takes that object's label with `probability`.

    The table keeps its points and is given none: an object's foot would otherwise become table all around it.
    """
    distance, other = _nearest_other(cloud, width)
    swapped = (distance <= width) & (rng.random(len(cloud.points)) < probability)
    return replace(cloud, labels=np.where(swapped, other, cloud.labels))


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
    return replace(cloud, labels=labels)


def cut_object(
    cloud: LabelledCloud, label: int, normal: ArrayLike, through: ArrayLike
) -> tuple[LabelledCloud, int]:
    """The cloud with an object divided by a plane, and the new label: of the part that `normal` points to."""
    own = (cloud.labels == label) & (cloud.labels > TABLE)
    beyond = own & ((cloud.points - np.asarray(through, float)) @ np.asarray(normal, float) > 0)
    if not beyond.any() or beyond.sum() == own.sum():
        raise InputError(
            f"the plane must divide object {label}, which has {own.sum()} points, {beyond.sum()} of them beyond it"
        )
    new = int(cloud.labels.max()) + 1
    return replace(cloud, labels=np.where(beyond, new, cloud.labels)), new


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
