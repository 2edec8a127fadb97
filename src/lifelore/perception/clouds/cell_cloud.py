"""Smallest distances between two clouds, exact: points sorted into cells, nearest cells searched first.

A k-d tree finds the distance of every point; a gap needs only the few smallest. So cells whose boxes are farther
apart than the distances found so far are skipped, and clouds that are far apart cost almost no time.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.perception.clouds.voxel import box_of

CELL = 0.02
"""Side of a cell, metres: some dozens of points at 3 mm spacing."""


class CellCloud(NamedTuple):
    """Points sorted by cell.

    points (n, 3): cell c holds rows ``starts[c]`` to ``starts[c + 1]``; low, high (n_cells, 3): box of its points.
    """

    points: NDArray[np.float64]
    starts: NDArray[np.int64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]


def cell_cloud(points: NDArray[np.float64], size: float = CELL) -> CellCloud:
    """Sort ``(n, 3)`` points, n ≥ 1, into cells of side `size`, metres."""
    low, high = box_of(points)
    cell = np.floor((points - low) / size).astype(np.int64)
    sides = np.floor((high - low) / size).astype(np.int64) + 1
    key = (cell[:, 0] * sides[1] + cell[:, 1]) * sides[2] + cell[:, 2]
    order = np.argsort(key, kind="stable")
    sorted_points = np.ascontiguousarray(points[order])
    firsts = np.flatnonzero(np.diff(key[order], prepend=-1))
    low = np.minimum.reduceat(sorted_points, firsts, axis=0)
    high = np.maximum.reduceat(sorted_points, firsts, axis=0)
    return CellCloud(sorted_points, np.append(firsts, len(points)), low, high)


def closest_distances(first: CellCloud, second: CellCloud, count: int, bound: float) -> NDArray[np.float64]:
    """The `count` smallest of the distances from each point of `first` to the nearest of `second`, ascending.

    Metres; distances above `bound` are left out, so fewer may come back.
    """
    nearest = _box_distances(first, second)
    found = _search(first, second, np.argsort(nearest), nearest, count, bound * bound)
    return np.sqrt(found[np.isfinite(found)])


@kernel
def _box_distances(first, second):
    """Squared distance from each cell of one cloud to the nearest cell of the other, (n_cells,)."""
    _, _, low, high = first
    _, _, low_second, high_second = second
    nearest = np.full(len(low), np.inf)
    for i in range(len(low)):
        for j in range(len(low_second)):
            square = 0.0
            for axis in range(3):
                gap = max(low[i, axis] - high_second[j, axis], low_second[j, axis] - high[i, axis])
                if gap > 0.0:
                    square += gap * gap
            nearest[i] = min(nearest[i], square)
    return nearest


@kernel
def _search(first, second, order, nearest, count, bound):
    """The `count` smallest squared distances, ascending, infinity for those above `bound`; cells in `order`."""
    points, starts, _, _ = first
    found = np.full(count, np.inf)
    for i in order:
        if nearest[i] > min(bound, found[-1]):
            break
        for p in range(starts[i], starts[i + 1]):
            square = _nearest(points[p], second, min(bound, found[-1]))
            if square <= bound:
                _insert(found, square)
    return found


@kernel
def _nearest(point, cloud, limit) -> float:
    """Squared distance from `point` to the nearest of a cell cloud, infinity where it exceeds `limit`."""
    points, starts, low, high = cloud
    best = np.inf
    for j in range(len(low)):
        square = 0.0
        for axis in range(3):
            gap = max(low[j, axis] - point[axis], point[axis] - high[j, axis])
            if gap > 0.0:
                square += gap * gap
        if square <= min(limit, best):
            for q in range(starts[j], starts[j + 1]):
                dx = point[0] - points[q, 0]
                dy = point[1] - points[q, 1]
                dz = point[2] - points[q, 2]
                best = min(best, dx * dx + dy * dy + dz * dz)
    return best if best <= limit else np.inf


@kernel
def _insert(found: NDArray[np.float64], square: float) -> None:
    """Put a number among the ascending ones and drop the greatest."""
    at = len(found) - 1
    if square >= found[at]:
        return
    while at > 0 and found[at - 1] > square:
        found[at] = found[at - 1]
        at -= 1
    found[at] = square
