"""Voxel pyramid of a pair of clouds: each voxel represents its points, with their summed cost."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.perception.separation.gaussian import Array

FINEST = 1 / 32
"""Edge of the smallest voxel, in lengths of the kernel; each coarser one is twice as wide."""
DOUBLINGS = 4
"""From the smallest voxel to the cell of the far field: half a length wide."""
COARSEST = 3
"""Doublings of the coarsest level: a quarter of a length, wider voxels describe their points too poorly."""
_GROWTH = 3.0
"""Least ratio of voxels between two levels; levels with more voxels are left out."""
_BITS = 17
"""Most bits of a voxel's index along an axis: three of them, the side and the cell's digits fit into 64."""


class Level(NamedTuple):
    """One resolution.

    points : (3, m) float64, centroids, in lengths of the kernel
    side : (m,) float64, +1 for the first cloud, -1 for the second
    cap : (m,) float64, greatest |β| of a voxel: the cost of all its points
    starts : (m + 1,) int64, voxel i holds the voxels starts[i] to starts[i + 1] - 1 of the next finer level;
        empty for the finest one, the points themselves
    edge : float, a voxel's edge in lengths of the kernel; 0 for the points themselves
    """

    points: Array
    side: Array
    cap: Array
    starts: NDArray[np.int64]
    edge: float


class VoxelPyramid(NamedTuple):
    """All levels, coarsest first, the last one being the points sorted by voxel.

    order : (n,) int64, the sorted points' places in the input
    cell_starts : (c + 1,) int64, where each far-field cell begins among the sorted points
    """

    levels: list[Level]
    order: NDArray[np.int64]
    cell_starts: NDArray[np.int64]


def voxel_pyramid(points: Array, side: Array, cost: float) -> VoxelPyramid:
    """Sort points (3, n), given in lengths of the kernel, into voxels, and sum the voxels up."""
    low = points.min(axis=1)
    span = float((points.max(axis=1) - low).max())
    edge = max(FINEST, span / (2.0**_BITS - 1))
    bits = max(int(span / edge).bit_length(), DOUBLINGS)
    key = np.empty(points.shape[1], np.int64)
    _voxel_keys(points, side, low, edge, bits - DOUBLINGS, key)
    order, key = _sorted(key, 1 + 3 * bits)
    points, side = np.ascontiguousarray(points[:, order]), side[order]
    n = len(side)
    levels = [Level(points, side, np.full(n, cost), np.empty(0, np.int64), 0.0)]
    begins, finer = np.arange(n), np.arange(n)
    for doubling in range(COARSEST + 1):
        begins = _begins(key >> (3 * doubling))
        if len(begins) * _GROWTH <= len(finer):
            levels.insert(0, _level(points, side, cost, begins, finer, edge * 2**doubling))
            finer = begins
    return VoxelPyramid(levels, order, np.append(_begins(key >> (3 * DOUBLINGS)), n))


@kernel
def _voxel_keys(points: Array, side: Array, low: Array, edge: float, bits: int, key: NDArray[np.int64]) -> None:
    """Write one whole number a point: side, cell (`bits` an axis), and the smaller and smaller voxels in it."""
    for i in range(key.shape[0]):
        x = np.int64((points[0, i] - low[0]) / edge)
        y = np.int64((points[1, i] - low[1]) / edge)
        z = np.int64((points[2, i] - low[2]) / edge)
        code = np.int64(0) if side[i] > 0 else np.int64(1)
        code = (code << bits) | (x >> DOUBLINGS)
        code = (code << bits) | (y >> DOUBLINGS)
        code = (code << bits) | (z >> DOUBLINGS)
        for shift in range(DOUBLINGS - 1, -1, -1):
            code = (code << 3) | (((x >> shift) & 1) << 2) | (((y >> shift) & 1) << 1) | ((z >> shift) & 1)
        key[i] = code


def _sorted(key: NDArray[np.int64], bits: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The stable order of keys of so many bits, and the keys in it; a plain sort if key and place fit in 63."""
    place_bits = len(key).bit_length()
    if bits + place_bits > 63:
        order = np.argsort(key, kind="stable")
        return order, key[order]
    both = np.sort((key << place_bits) | np.arange(len(key)))
    return both & ((1 << place_bits) - 1), both >> place_bits


def _begins(key: NDArray[np.int64]) -> NDArray[np.int64]:
    """First index of each run of equal keys."""
    return np.append(0, np.flatnonzero(key[1:] != key[:-1]) + 1)


def _level(
    points: Array, side: Array, cost: float, begins: NDArray[np.int64], finer: NDArray[np.int64], edge: float
) -> Level:
    counts = np.diff(begins, append=len(side))
    centroids = np.add.reduceat(points, begins, axis=1) / counts
    starts = np.append(np.searchsorted(finer, begins), len(finer))
    return Level(np.ascontiguousarray(centroids), side[begins], cost * counts, starts, edge)
