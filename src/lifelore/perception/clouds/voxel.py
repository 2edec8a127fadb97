"""Voxel thinning: one point per label and small cube, so that clouds of any density get the same density.

Voxels belong to labels: where two objects share a cube, each keeps a point in it.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.perception.clouds.point_cloud import PointCloud

VOXEL = 0.003
"""Metres; about the spacing of a depth camera at one to two metres."""
_KEY_LIMIT = 2**61
_LOW = 2**31 - 1
MAX_SCENE_POINTS = 2_000_000
"""Largest number of points of a scene; larger clouds are thinned first. More cost time and memory."""


class Voxels(NamedTuple):
    """The m occupied voxels of n points, in the order in which they first occur.

    inverse (n,): voxel of each point; first (m,): first point of each voxel; counts (m,): its number of points,
    ≥ 1; means (m, 3): the mean of its points, metres.
    """

    inverse: NDArray[np.int64]
    first: NDArray[np.int64]
    counts: NDArray[np.int64]
    means: NDArray[np.float64]


def voxelised(cloud: LabelledCloud, size: float = VOXEL) -> LabelledCloud:
    """The cloud with one point a voxel and label: the mean of its points, with the colour of the first.

    Parameters
    ----------
    cloud : LabelledCloud
    size : float
        Side of a voxel, metres, > 0.

    Raises
    ------
    InputError
        The size is not positive, or so small that the voxels cannot be numbered.

    Examples
    --------
    >>> cloud = LabelledCloud(np.array([[0.0, 0, 0], [0.001, 0, 0], [0.001, 0, 0]]), np.array([2, 2, 3]))
    >>> thin = voxelised(cloud)
    >>> thin.labels.tolist(), thin.points[0].tolist()
    ([2, 3], [0.0005, 0.0, 0.0])
    """
    found = voxels_of(cloud.points, size, cloud.labels)
    colours = None if cloud.colours is None else cloud.colours[found.first]
    return LabelledCloud(found.means, cloud.labels[found.first], colours, cloud.camera, cloud.other_cameras)


def thinned(cloud: PointCloud, size: float = VOXEL, at_most: int = MAX_SCENE_POINTS) -> PointCloud:
    """The cloud itself while it has at most `at_most` measured points; else its voxels.

    Voxels are means of points, so that they have no pixels (`grid` is None) and no rows in the source. Where the
    voxels are more than `at_most`, their size doubles until they are not.
    """
    if len(cloud.points) <= at_most or np.count_nonzero(cloud.measured) <= at_most:
        return cloud
    cloud = cloud.only(cloud.measured)
    every = cloud.points.astype(np.float64)
    found = voxels_of(every, size, cloud.labels)
    while len(found.means) > at_most:
        size *= 2
        found = voxels_of(every, size, cloud.labels)
    points = found.means.astype(cloud.points.dtype)
    return replace(cloud.only(found.first), points=points, grid=None, source_rows=np.full(len(points), -1))


def voxels_of(points: NDArray[np.float64], size: float, labels: NDArray[np.int64] | None = None) -> Voxels:
    """The voxels of finite points (n, 3), those of different `labels` (n,) apart; raises as `voxelised`."""
    if not (np.isfinite(size) and size > 0):
        raise InputError(f"size must be a positive number of metres, got {size}")
    n = len(points)
    if n == 0:
        none = np.empty(0, np.int64)
        return Voxels(none, none, none, np.empty((0, 3)))
    labels = np.zeros(n, np.int64) if labels is None else labels
    lowest, highest = box_of(points)
    # Multiples of the size in the frame, so that the cube of a point does not depend on the other points.
    low = np.floor(lowest / size) * size
    sides = np.floor((highest - low) / size) + 1.0
    if np.prod(sides) * (labels.max() + 1.0) > _KEY_LIMIT:
        labels = np.unique(labels, return_inverse=True)[1].reshape(-1)
        if np.prod(sides) * (labels.max() + 1) > _KEY_LIMIT:
            span = (highest - lowest).max()
            raise InputError(f"size {size} m is too small for a cloud of {span:.3g} m; take a larger one")
    inverse, first = _number_voxels(points, labels, low, 1.0 / size, sides.astype(np.int64))
    counts, means = _average(points, inverse, len(first))
    return Voxels(inverse, first, counts, means)


@kernel
def box_of(points: NDArray[np.floating]) -> NDArray[np.float64]:
    """(2, 3): least and greatest corner of the box of points (n, 3), n ≥ 1.

    At 150,000 points this is more than ten times as fast as `numpy.min` and `numpy.max` along the first axis.
    """
    box = np.empty((2, 3))
    box[0], box[1] = np.inf, -np.inf
    for i in range(len(points)):
        for axis in range(3):
            box[0, axis] = min(box[0, axis], points[i, axis])
            box[1, axis] = max(box[1, axis], points[i, axis])
    return box


@kernel
def _number_voxels(points, labels, low, per_metre, sides):
    """The voxel of each point, and the first point of each voxel; voxels are numbered as they first occur.

    The cell of each point is hashed by open addressing.
    """
    n = len(points)
    slots = 1
    while slots < 2 * n:
        slots *= 2
    mask = slots - 1
    table = np.full(slots, -1, np.int32)
    inverse, keys, first = np.empty(n, np.int64), np.empty(n, np.int64), np.empty(n, np.int64)
    m = 0
    for i in range(n):
        key = labels[i]
        for axis in range(3):
            cell = int(np.floor((points[i, axis] - low[axis]) * per_metre))
            key = key * sides[axis] + min(max(cell, 0), sides[axis] - 1)
        # Both products stay below 2^62: plain Python and machine code agree without wrapping round.
        mixed = (key & _LOW) * 1_640_531_527 + (key >> 31) * 668_265_263
        slot = (mixed ^ (mixed >> 29)) & mask
        while table[slot] >= 0 and keys[table[slot]] != key:
            slot = (slot + 1) & mask
        if table[slot] < 0:
            table[slot] = m
            keys[m] = key
            first[m] = i
            m += 1
        inverse[i] = table[slot]
    return inverse, first[:m].copy()


@kernel
def _average(points, inverse, m):
    """The number of points of each of `m` voxels, (m,), and their mean, (m, 3)."""
    counts, means = np.zeros(m, np.int64), np.zeros((m, 3))
    for i in range(len(points)):
        counts[inverse[i]] += 1
        for axis in range(3):
            means[inverse[i], axis] += points[i, axis]
    for voxel in range(len(counts)):
        for axis in range(3):
            means[voxel, axis] /= counts[voxel]
    return counts, means
