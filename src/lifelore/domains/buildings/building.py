"""A building as a grid world: from a map's pixels to cells a robot can stand in and moves it can make.

A cell is the largest connected piece of free space within its square (`free_space`). Two cells are joined exactly
where their pieces touch.
"""

import math

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.core.errors import InputError
from lifelore.domains.buildings.free_space import EDGE, SquareGrid, pieces_of
from lifelore.domains.buildings.occupancy_map import OccupancyMap
from lifelore.domains.buildings.slivers import without_slivers
from lifelore.domains.grids.grid_world import Frame, GridWorld

MAX_STATES = 2_000_000
_MAX_CELL, _MAX_RADIUS = 1000.0, 100.0  # metres; larger is a slip of units


def building_from_map(
    occupancy: OccupancyMap,
    cell: float = 0.5,
    robot_radius: float = 0.2,
    discount: float = 0.99,
    goal_reward: float = 100.0,
    wall_reward: float = -10.0,
    min_free: float = 0.25,
) -> GridWorld:
    """The building a round robot can move in, as a grid world.

    The robot's disc must lie in space known to be free: all other pixels, occupied, unknown or outside the
    picture, are grown by its radius at full resolution (pixel centre to pixel centre, as in ROS costmaps), which
    also cuts off the stray beams that a laser throws through windows. Specks of unknown (`free_space.SPECK`) are
    not free, but do not grow: they are a mapper's noise in open floor. A cell of `cell` metres is its largest
    4-connected piece of free pixels (of equal ones, the first from the top left). A move exists exactly where the
    pieces of two neighbouring cells touch across their border. The largest connected region of cells is kept (of
    equal ones, the first from the top left), less its slivers (`min_free`).

    Parameters
    ----------
    occupancy : OccupancyMap
    cell : float
        Side of a cell in metres; at least a pixel, need not be a multiple of one. Cells are counted from
        the map's origin, its lower left corner, and a pixel belongs to the cell its centre lies in.
    robot_radius : float
        In metres, at least 0.
    discount, goal_reward, wall_reward : float
        γ in [0, 1) and the rewards, as in `GridWorld`.
    min_free : float
        In [0, 1]: cells whose piece covers less than this share of the square are no places of their own and
        stay only where they join larger ones or lead on for more than two cells; 0 keeps every sliver.

    Returns
    -------
    GridWorld
        Connected; moves go both ways; states in reading order; ``frame`` holds `cell` and the origin.

    Raises
    ------
    InputError
        `cell`, `robot_radius` or `min_free` breaks its rule, no region of at least two cells is free, or more than
        `MAX_STATES` cells are.

    Examples
    --------
    >>> from lifelore.domains.buildings.office import office_map
    >>> office = office_map(seed=1, width_m=16.0, height_m=12.0)
    >>> building_from_map(office, cell=1.0, robot_radius=0.2).n_states > 50
    True
    """
    _check(occupancy, cell, robot_radius, min_free)
    _, free, grid, largest = pieces_of(occupancy, float(cell), float(robot_radius))
    if not free.any():
        raise InputError(
            f"map: no free cell is left for robot_radius {robot_radius} m at {occupancy.resolution} m a pixel "
            "(unknown pixels are not free); use a smaller robot_radius or check the map's thresholds"
        )
    pixels = grid.counts(largest)
    cells, neighbour = _largest_region(pixels > 0, *_touching(largest, grid))
    share = pixels[tuple(cells.T)] / (cell / occupancy.resolution) ** 2
    cells, neighbour = _only(without_slivers(neighbour, share, min_free), cells, neighbour)
    if len(cells) < 2:
        raise InputError(
            f"map: the largest free region has only one cell at cell {cell} m, robot_radius {robot_radius} m; "
            "use a smaller cell or robot_radius"
        )
    return GridWorld(
        name="building",
        shape=grid.shape,
        cells=cells,
        neighbour=neighbour,
        discount=discount,
        goal_reward=goal_reward,
        wall_reward=wall_reward,
        frame=Frame(float(cell), occupancy.origin),
        about={"cell": float(cell), "robot_radius": float(robot_radius), "min_free": float(min_free)},
    )


def _check(occupancy: OccupancyMap, cell: float, robot_radius: float, min_free: float) -> None:
    if not (math.isfinite(cell) and 0 < cell <= _MAX_CELL):
        raise InputError(f"cell must lie in (0, {_MAX_CELL:g}] metres, got {cell}")
    if cell < occupancy.resolution * (1 - EDGE):
        raise InputError(
            f"cell must be at least a pixel of the map, {occupancy.resolution} m, got {cell} m; use a larger cell"
        )
    if not (math.isfinite(robot_radius) and 0 <= robot_radius <= _MAX_RADIUS):
        raise InputError(f"robot_radius must lie in [0, {_MAX_RADIUS:g}] metres, got {robot_radius}")
    if not 0 <= min_free <= 1:
        raise InputError(f"min_free must be a share of the cell in [0, 1], got {min_free}")


def _touching(largest: NDArray[np.bool_], grid: SquareGrid):
    """Between which cells (south, east) the pieces touch; bool grids."""
    first_row, first_column = grid.first
    below, right = first_row[1:], first_column[1:]
    south = np.logical_or.reduceat(largest[below - 1] & largest[below], first_column, axis=1)
    east = np.logical_or.reduceat(largest[:, right - 1] & largest[:, right], first_row, axis=0)
    return south, east


def _largest_region(exists: NDArray[np.bool_], south: NDArray[np.bool_], east: NDArray[np.bool_]):
    """Cells (n, 2) and moves (n, 4) of the largest connected region, in reading order."""
    number = np.full(exists.shape, -1, np.int64)
    number[exists] = np.arange(exists.sum())
    pairs = [(number[:-1][south], number[1:][south]), (number[:, :-1][east], number[:, 1:][east])]
    a, b = np.concatenate([pairs[0], pairs[1]], axis=1)
    n = int(exists.sum())
    if n > MAX_STATES:
        raise InputError(f"map: at most {MAX_STATES} cells are supported, got {n}; use a larger cell")
    graph = sparse.coo_matrix((np.ones(len(a), bool), (a, b)), shape=(n, n))
    region = csgraph.connected_components(graph, directed=False)[1]
    kept = region == np.argmax(np.bincount(region, minlength=1))
    state = np.where(kept, np.cumsum(kept) - 1, -1)
    neighbour = np.full((n, 4), -1, np.int32)
    for (near, far), (there, back) in zip(pairs, ((1, 0), (2, 3)), strict=True):
        neighbour[near, there] = state[far]
        neighbour[far, back] = state[near]
    return np.argwhere(exists)[kept].astype(np.int32), np.ascontiguousarray(neighbour[kept])


def _only(kept: NDArray[np.bool_], cells: NDArray, neighbour: NDArray):
    """The kept cells and the moves among them, numbered anew in the same order."""
    number = np.where(kept, np.cumsum(kept) - 1, -1).astype(np.int32)
    return cells[kept], np.where(neighbour[kept] >= 0, number[neighbour[kept]], -1).astype(np.int32)
