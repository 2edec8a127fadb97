"""Finds the pixels in which a round robot's centre may be, and cuts them into the pieces of square cells.

Sampling cell centres loses narrow rooms and walks through thin walls. Here a cell is the largest connected piece
of free space within its square.
"""

from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from lifelore.domains.buildings.inflation import inflate
from lifelore.domains.buildings.occupancy_map import FREE, UNKNOWN, OccupancyMap

SPECK = 0.01
"""Square metres: unknown pixels that hang together (also by corners) and cover no more are a speck."""
EDGE = 1e-9
"""Relative tolerance: a pixel centre on a cell's border belongs to the cell above it, despite rounding."""


class SquareGrid(NamedTuple):
    """Which cell row and column each pixel row and column lies in, counted from the top left."""

    shape: tuple[int, int]
    row_of: NDArray[np.int64]
    column_of: NDArray[np.int64]

    @property
    def first(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The first pixel row of each cell row, and the first pixel column of each cell column."""
        first_row, first_column = (np.unique(of, return_index=True)[1] for of in (self.row_of, self.column_of))
        return first_row, first_column

    def counts(self, pixels: NDArray[np.bool_]) -> NDArray[np.int32]:
        """How many pixels each cell has of those that are true, (rows, columns) of cells."""
        first_row, first_column = self.first
        in_columns = np.add.reduceat(pixels, first_row, axis=0, dtype=np.int32)
        return np.add.reduceat(in_columns, first_column, axis=1)


def solid_pixels(occupancy: OccupancyMap) -> NDArray[np.bool_]:
    """Pixels that grow by the robot's radius: all that are not free, except specks of unknown."""
    unknown = occupancy.state == UNKNOWN
    if not unknown.any():
        return occupancy.state != FREE
    piece = np.asarray(ndimage.label(unknown, np.ones((3, 3)))[0], np.int64)  # type: ignore[index]
    small = np.bincount(piece.ravel()) * occupancy.resolution**2 <= SPECK * (1 + EDGE)
    return (occupancy.state != FREE) & ~(unknown & small[piece])


def free_pixels(occupancy: OccupancyMap, solid: NDArray[np.bool_], robot_radius: float) -> NDArray[np.bool_]:
    """Free pixels whose centre is farther than `robot_radius` metres from the centre of every solid pixel.

    Nothing is known beyond the picture's edge, so a rim of solid pixels surrounds the picture.
    """
    rimmed = np.pad(solid, 1, constant_values=True)
    return ~inflate(rimmed, robot_radius / occupancy.resolution)[1:-1, 1:-1] & (occupancy.state == FREE)


def square_grid(pixels: tuple[int, int], resolution: float, cell: float) -> SquareGrid:
    """The squares of side `cell` metres, counted from the lower left corner of a picture of `pixels`."""
    rows, columns = pixels
    from_bottom, column_of = (
        np.floor((np.arange(n) + 0.5) * resolution / cell + EDGE).astype(np.int64) for n in (rows, columns)
    )
    shape = (int(from_bottom[-1]) + 1, int(column_of[-1]) + 1)
    return SquareGrid(shape, shape[0] - 1 - from_bottom[::-1], column_of)


class Pieces(NamedTuple):
    """The free space of a map, cut into pieces.

    solid, free : as of `solid_pixels` and `free_pixels`
    grid : the squares
    largest : as of `largest_pieces`
    """

    solid: NDArray[np.bool_]
    free: NDArray[np.bool_]
    grid: SquareGrid
    largest: NDArray[np.bool_]


_PIECES: WeakKeyDictionary[OccupancyMap, tuple[tuple, Pieces]] = WeakKeyDictionary()
"""The last pieces of each map, and what they were made of: a building's world and its floor need the same ones."""


def pieces_of(occupancy: OccupancyMap, cell: float, robot_radius: float) -> Pieces:
    """The pieces of a map for squares of side `cell` and a robot of this radius, both in metres."""
    made_of = cell, robot_radius, hash(occupancy.state.tobytes())
    if (last := _PIECES.get(occupancy)) and last[0] == made_of:
        return last[1]
    solid = solid_pixels(occupancy)
    free = free_pixels(occupancy, solid, robot_radius)
    grid = square_grid(free.shape, occupancy.resolution, cell)
    pieces = Pieces(solid, free, grid, largest_pieces(free, grid))
    _PIECES[occupancy] = made_of, pieces
    return pieces


def largest_pieces(free: NDArray[np.bool_], grid: SquareGrid) -> NDArray[np.bool_]:
    """The free pixels that belong to the largest piece of their cell, (rows, columns) bool.

    Pieces are 4-connected. Of equally large pieces, the first from the top left is taken.
    """
    # A cell with all its pixels is one piece; only the others need labels.
    covered = grid.counts(free) == np.multiply.outer(np.bincount(grid.row_of), np.bincount(grid.column_of))
    chosen = free & covered[np.ix_(grid.row_of, grid.column_of)]
    row, column = np.nonzero(free & ~chosen)
    cell_row, cell_column = grid.row_of[row], grid.column_of[column]
    # An empty line between neighbouring cells keeps one labelling pass from joining pieces across them.
    apart = np.zeros(np.add(free.shape, grid.shape), np.bool_)
    apart[row + cell_row, column + cell_column] = True
    labels = np.zeros(apart.shape, np.int32)
    n_pieces = int(ndimage.label(apart, output=labels))  # type: ignore[arg-type]
    piece = labels[row + cell_row, column + cell_column]
    size = np.bincount(piece, minlength=n_pieces + 1)
    cell_of_piece = np.zeros(n_pieces + 1, np.int64)
    cell_of_piece[piece] = cell_row * grid.shape[1] + cell_column
    pieces = np.arange(1, n_pieces + 1)
    # Labels run in reading order, so the last key settles ties.
    order = pieces[np.lexsort((pieces, -size[1:], cell_of_piece[1:]))]
    first_of_cell = np.unique(cell_of_piece[order], return_index=True)[1]
    largest = np.zeros(n_pieces + 1, dtype=bool)
    largest[order[first_of_cell]] = True
    chosen[row, column] = largest[piece]
    return chosen
