"""Height maps of a table: the highest point over each cell, where the view shows the cell at all."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.registration.tabletop_view import TabletopView

EMPTY_BELOW = 0.015
"""Metres over the table below which a cell counts as empty; less makes objects of the sensor's noise."""
UNSEEN = -1.0


@dataclass(frozen=True, eq=False)
class HeightMap:
    """Highest points over square cells.

    Parameters
    ----------
    heights : (nx, ny) float64
        Metres over the table; 0 where the view shows the bare table, `UNSEEN` where it shows nothing.
    low : (2,) int64
        Number of the first cell along x and y; cell i reaches from i to i + 1 cell sizes.
    """

    heights: NDArray[np.float64]
    low: NDArray[np.int64]

    @property
    def objects(self) -> NDArray[np.bool_]:
        """(nx, ny): cells with an object."""
        return self.heights > EMPTY_BELOW

    @property
    def seen(self) -> NDArray[np.bool_]:
        """(nx, ny): cells with an object or the bare table."""
        return self.heights > UNSEEN


def moved_surface(view: TabletopView, motion: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
    """The voxels of objects and table after a rigid motion (4, 4)."""
    return tuple(points @ motion[:3, :3].T + motion[:3, 3] for points in (view.objects, view.table))


def cells_spanned(points: NDArray[np.float64], cell: float) -> tuple[NDArray[np.int64], tuple[int, int]]:
    """First cell (2,) and numbers of cells (nx, ny) that hold points (n, 2 or 3)."""
    numbers = np.floor(points[:, :2] / cell).astype(np.int64)
    low = numbers.min(axis=0)
    spans = numbers.max(axis=0) - low + 1
    return low, (int(spans[0]), int(spans[1]))


def height_map(
    objects: NDArray[np.float64],
    table: NDArray[np.float64],
    cell: float,
    low: NDArray[np.int64],
    shape: tuple[int, int],
) -> HeightMap:
    """The height map of points (m, 3) of objects and (k, 3) of the table, all within the given cells."""
    heights = np.full(shape, UNSEEN)
    across, along = (np.floor(table[:, :2] / cell).astype(np.int64) - low).T
    heights[across, along] = 0.0
    across, along = (np.floor(objects[:, :2] / cell).astype(np.int64) - low).T
    np.maximum.at(heights, (across, along), np.maximum(objects[:, 2], 0.0))
    return HeightMap(heights, low)
