"""Numbers of a grid's cells that stay the same in every map of one building.

Cells are numbered from the lower left corner of the frame, because a changed map may number its states differently
or have a larger picture.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.grids.grid_world import GridWorld

COLUMN_BITS = 20
"""Bits of a cell number that hold the column."""


class BuildingGrid(NamedTuple):
    """The grid that all maps of a building share.

    frame : hash of the grid's frame and settings
    corner : cell (row, column) of a world's lower left corner, counted from that of the building's first map
    building : key of the building in memory; None if memory stores no map of it
    """

    frame: str
    corner: tuple[int, int] = (0, 0)
    building: str | None = None


def cells_of(world: GridWorld) -> NDArray[np.int64]:
    """The number of each state's cell, (n_states,): 2²⁰ · row from the bottom + column."""
    return ((world.shape[0] - 1 - world.cells[:, 0].astype(np.int64)) << COLUMN_BITS) | world.cells[:, 1]


def states_in(world: GridWorld, cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """The state in each of `cells`, -1 where this world has none."""
    row, column = world.shape[0] - 1 - (cells >> COLUMN_BITS), cells & (2**COLUMN_BITS - 1)
    inside = (row >= 0) & (row < world.shape[0]) & (column < world.shape[1])
    return np.where(inside, world.state_of[np.where(inside, row, 0), np.where(inside, column, 0)], -1)


def shifted(cells: NDArray[np.int64], shift: tuple[int, int]) -> NDArray[np.int64]:
    """Numbers of the same cells counted from another corner; -1 for cells below or left of it."""
    row, column = (cells >> COLUMN_BITS) + shift[0], (cells & (2**COLUMN_BITS - 1)) + shift[1]
    return np.where((row >= 0) & (column >= 0), (row << COLUMN_BITS) | column, -1)


def cells_in_building(world: GridWorld, corner: tuple[int, int]) -> NDArray[np.int64]:
    """The number of each state's cell in the grid of the building's first map; -1 below or left of it."""
    return shifted(cells_of(world), corner)


def states_in_building(world: GridWorld, cells: NDArray[np.int64], corner: tuple[int, int]) -> NDArray[np.int64]:
    """The state in each of `cells`, numbered in the grid of the building's first map; -1 where there is none."""
    return states_in(world, shifted(cells, (-corner[0], -corner[1])))
