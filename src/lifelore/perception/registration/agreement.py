"""Agreement of two registered views: cells of the table that both show, and what they say of them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from lifelore.perception.registration.height_map import HeightMap, cells_spanned, height_map, moved_surface
from lifelore.perception.registration.tabletop_view import TabletopView

CELL = 0.01
SAME = 0.015
"""Metres between heights that agree; more lets different objects agree."""
MOVED = 2
"""Cells: least width and length of a place where something moved."""
AGAINST = 3.0
"""Agreeing cells that one contradicting cell outweighs."""


@dataclass(frozen=True, eq=False)
class Agreement:
    """Cells with objects of either view.

    Parameters
    ----------
    agreeing, contradicting : int
        Cells that the other view shows too: within the heights of this cell and those around it, or not.
    cells : int
        All of them.
    moved : (3,) float64, optional
        Metres, in the target's frame: the middle of the largest place that contradicts as a whole, at least
        `MOVED` cells wide and long. Something moved there: noise and rims contradict in single cells and lines.
    """

    agreeing: int
    contradicting: int
    cells: int
    moved: NDArray[np.float64] | None = None

    @property
    def share(self) -> float:
        """Share of the agreeing among the cells that both views show."""
        return self.agreeing / max(1, self.agreeing + self.contradicting)

    @property
    def evidence(self) -> float:
        """Agreeing cells less `AGAINST` times the contradicting ones, as a share of all cells; at most 1."""
        return (self.agreeing - AGAINST * self.contradicting) / max(1, self.cells)


def agreement(target: TabletopView, source: TabletopView, motion: NDArray[np.float64]) -> Agreement:
    """How well `source` after `motion` (4, 4) agrees with `target`."""
    objects, table = moved_surface(source, motion)
    low, shape = cells_spanned(np.concatenate([target.surface, objects, table]), CELL)
    first = height_map(target.objects, target.table, CELL, low, shape)
    second = height_map(objects, table, CELL, low, shape)
    same_first, against_first = _compared(first, second)
    same_second, against_second = _compared(second, first)
    places = [_moved(first, against_first), _moved(second, against_second)]
    return Agreement(
        int(same_first.sum() + same_second.sum()),
        int(against_first.sum() + against_second.sum()),
        int(first.objects.sum() + second.objects.sum()),
        max(places, key=lambda place: place[0])[1],
    )


def _moved(own: HeightMap, against: NDArray[np.bool_]) -> tuple[int, NDArray[np.float64] | None]:
    """Number of cells and middle (3,) of the largest contradicting place; 0 and None where all are thin."""
    thick = ndimage.binary_opening(against, np.ones((MOVED, MOVED)))
    if not thick.any():
        return 0, None
    numbers = np.asarray(ndimage.label(thick, np.ones((3, 3)))[0], np.int64)  # type: ignore[index]
    sizes = np.bincount(numbers.ravel())[1:]
    cells = np.argwhere(numbers == sizes.argmax() + 1)
    height = float(own.heights[tuple(cells.T)].mean()) / 2
    return int(sizes.max()), np.append((cells.mean(axis=0) + own.low + 0.5) * CELL, height)


def _compared(own: HeightMap, other: HeightMap) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Agreeing and contradicting cells with objects of `own`.

    A cell counts only if the other view shows all nine cells around it. It agrees if its height lies between their
    lowest and highest: at a rim, the top, the side and the table share cells.
    """
    objects = own.objects
    shown = np.asarray(ndimage.minimum_filter(other.seen, 3, mode="constant", cval=False), bool) & objects
    lowest, highest = (limit(other.heights, 3) for limit in (ndimage.minimum_filter, ndimage.maximum_filter))
    same = (own.heights > lowest - SAME) & (own.heights < highest + SAME)
    return shown & same, shown & ~same
