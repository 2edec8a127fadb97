"""Finds the pixels in which a round robot's centre may be, and cuts them into the pieces of square cells.

Sampling cell centres loses narrow rooms and walks through thin walls. Here a cell is the largest connected piece
of free space within its square.
"""

from typing import NamedTuple

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


def solid_pixels(occupancy: OccupancyMap) -> NDArray[np.bool_]:
    """Pixels that grow by the robot's radius: all that are not free, except specks of unknown."""
    unknown = occupancy.state == UNKNOWN
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


def pieces_of(occupancy: OccupancyMap, cell: float, robot_radius: float) -> Pieces:
    """The pieces of a map for squares of side `cell` and a robot of this radius, both in metres."""
    solid = solid_pixels(occupancy)
    free = free_pixels(occupancy, solid, robot_radius)
    grid = square_grid(free.shape, occupancy.resolution, cell)
    return Pieces(solid, free, grid, largest_pieces(free, grid))


def largest_pieces(free: NDArray[np.bool_], grid: SquareGrid) -> NDArray[np.bool_]:
    """The free pixels that belong to the largest piece of their cell, (rows, columns) bool.

    Pieces are 4-connected. Of equally large pieces, the first from the top left is taken.
    """
    # An empty line between neighbouring cells keeps one labelling pass from joining pieces across them.
    place = np.ix_(np.arange(free.shape[0]) + grid.row_of, np.arange(free.shape[1]) + grid.column_of)
    apart = np.zeros((place[0][-1, 0] + 1, place[1][0, -1] + 1), dtype=bool)
    apart[place] = free
    labels = np.zeros(apart.shape, np.int32)
    n_pieces = int(ndimage.label(apart, output=labels))  # type: ignore[arg-type]
    piece = labels[place]
    size = np.bincount(piece.ravel(), minlength=n_pieces + 1)
    cell_of_piece = np.zeros(n_pieces + 1, np.int64)
    cell_of_piece[piece] = grid.row_of[:, None] * grid.shape[1] + grid.column_of
    pieces = np.arange(1, n_pieces + 1)
    # Labels run in reading order, so the last key settles ties.
    order = pieces[np.lexsort((pieces, -size[1:], cell_of_piece[1:]))]
    first_of_cell = np.unique(cell_of_piece[order], return_index=True)[1]
    chosen = np.zeros(n_pieces + 1, dtype=bool)
    chosen[order[first_of_cell]] = True
    return chosen[piece]
