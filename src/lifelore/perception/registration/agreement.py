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
AGAINST = 3.0
"""Agreeing cells that one contradicting cell outweighs."""


@dataclass(frozen=True)
class Agreement:
    """Cells with objects of either view.

    Parameters
    ----------
    agreeing, contradicting : int
        Cells that the other view shows too: within the heights of this cell and those around it, or not.
    cells : int
        All of them.
    """

    agreeing: int
    contradicting: int
    cells: int

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
    counts = np.array([_counts(first, second), _counts(second, first)]).sum(axis=0)
    return Agreement(*counts.tolist())


def _counts(own: HeightMap, other: HeightMap) -> tuple[int, int, int]:
    """Agreeing, contradicting and all cells with objects of `own`.

    A cell counts only if the other view shows all nine cells around it. It agrees if its height lies between their
    lowest and highest: at a rim, the top, the side and the table share cells.
    """
    objects = own.objects
    shown = np.asarray(ndimage.minimum_filter(other.seen, 3, mode="constant", cval=False), bool) & objects
    lowest, highest = (limit(other.heights, 3) for limit in (ndimage.minimum_filter, ndimage.maximum_filter))
    same = (own.heights > lowest - SAME) & (own.heights < highest + SAME)
    agreeing = int(np.count_nonzero(shown & same))
    return agreeing, int(np.count_nonzero(shown)) - agreeing, int(np.count_nonzero(objects))
