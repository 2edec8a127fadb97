"""Pictures of the Pacman maze in the colours of the thesis's Figure 4.7: RGB arrays from NumPy alone."""

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.grids.grid_picture import draw_grid
from lifelore.domains.pacman.pacman import PacmanTask

PACMAN_COLOUR, GHOST_COLOUR, FOOD_COLOUR = (240, 196, 32), (44, 92, 204), (204, 68, 62)
_UNSEEN = 0.6
"""How far a ghost that Pacman cannot see is blended towards white."""


def draw_pacman(task: PacmanTask, state: int) -> NDArray[np.uint8]:
    """Maze, foods left, Pacman, and the ghost, pale where Pacman does not see it; (height, width, 3) uint8.

    Parameters
    ----------
    task : PacmanTask
    state : int
        Hidden state, in [0, n_states).
    """
    grid = task.maze.grid
    picture = draw_grid(grid)
    side = len(picture) // grid.shape[0]
    own, ghost, left = (int(part) for part in task.parts(state))
    for bit, food in enumerate(task.foods):
        if left >> bit & 1:
            picture[_square(grid.cells[food], side)][_disc(side, 0.16)] = FOOD_COLOUR
    picture[_square(grid.cells[own], side)][_disc(side, 0.4) & ~_mouth(side)] = PACMAN_COLOUR
    colour = np.array(GHOST_COLOUR, float)
    if not task.maze.sees[own, ghost]:
        colour += (255 - colour) * _UNSEEN
    picture[_square(grid.cells[ghost], side)][_ghost(side)] = colour.round().astype(np.uint8)
    return picture


def _square(cell: NDArray[np.int32], side: int) -> tuple[slice, slice]:
    row, column = (int(x) * side for x in cell)
    return slice(row, row + side), slice(column, column + side)


def _offsets(side: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Down and right from the centre of a cell, in sides of it."""
    offset = (np.arange(side) - (side - 1) / 2) / side
    return offset[:, None], offset[None, :]


def _disc(side: int, radius: float) -> NDArray[np.bool_]:
    down, right = _offsets(side)
    return down**2 + right**2 <= radius**2


def _mouth(side: int) -> NDArray[np.bool_]:
    down, right = _offsets(side)
    return (right > 0) & (np.abs(down) < 0.6 * right)


def _ghost(side: int) -> NDArray[np.bool_]:
    """A dome on a skirt with two eyes."""
    down, right = _offsets(side)
    dome = (down < 0) & _disc(side, 0.36)
    skirt = (down >= 0) & (down <= 0.36 - 0.07 * np.cos(right * 2 * np.pi / 0.24)) & (np.abs(right) <= 0.36)
    eyes = (down + 0.1) ** 2 + (np.abs(right) - 0.14) ** 2 <= 0.07**2
    return (dome | skirt) & ~eyes
