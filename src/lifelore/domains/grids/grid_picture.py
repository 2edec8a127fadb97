"""Pictures of grid worlds: RGB arrays from NumPy alone."""

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.grids.grid_world import GridWorld

_WALL, _FLOOR, _EDGE = (62, 68, 82), (247, 246, 242), (150, 156, 168)
GOAL_COLOUR, AGENT_COLOUR = (38, 145, 104), (214, 92, 52)
_PICTURE_SIDE = 640


def draw_grid(world: GridWorld, agent: int | None = None, goal: int | None = None) -> NDArray[np.uint8]:
    """A picture of the world; refused moves between two cells side by side are drawn as lines.

    Parameters
    ----------
    world : GridWorld
    agent, goal : int, optional
        States to mark.

    Returns
    -------
    picture : (height, width, 3) uint8
        Cells are squares of equal size, the longer side about 640 pixels (at least 3 a cell).
    """
    side = max(3, _PICTURE_SIDE // max(world.shape))
    picture = np.full((*world.shape, 3), _WALL, np.uint8)
    picture[tuple(world.cells.T)] = _FLOOR
    if goal is not None:
        picture[tuple(world.cells[goal])] = GOAL_COLOUR
    picture = picture.repeat(side, axis=0).repeat(side, axis=1)
    _draw_barriers(picture, world, side)
    if agent is not None:
        _draw_disc(picture, world.cells[agent], side)
    return picture


def _draw_barriers(picture: NDArray[np.uint8], world: GridWorld, side: int) -> None:
    """A line between two cells that lie side by side and are not joined: a wall thinner than a cell."""
    for move, (d_row, d_column) in ((1, (1, 0)), (2, (0, 1))):
        refused = world.cells[world.neighbour[:, move] < 0]
        beside = np.pad(world.state_of, (0, 1), constant_values=-1)[
            refused[:, 0] + d_row, refused[:, 1] + d_column
        ]
        for row, column in refused[beside >= 0]:
            top, left = (row + d_row) * side, (column + d_column) * side
            if d_row:
                picture[top - 1 : top + 1, left : left + side] = _EDGE
            else:
                picture[top : top + side, left - 1 : left + 1] = _EDGE


def _draw_disc(picture: NDArray[np.uint8], cell: NDArray[np.int32], side: int) -> None:
    offset = np.arange(side) - (side - 1) / 2
    disc = offset[:, None] ** 2 + offset**2 <= (0.45 * side) ** 2
    row, column = cell * side
    picture[row : row + side, column : column + side][disc] = AGENT_COLOUR
