"""Pictures of the reserve in the colours of the thesis's Figure 4.9: RGB arrays from NumPy alone."""

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.surveillance.surveillance import BASE, SIDE, Surveillance

GROUND_COLOUR, LINE_COLOUR = (247, 246, 242), (222, 222, 214)
BASE_COLOUR, TARGET_COLOUR, HILL_COLOUR = (205, 62, 56), (74, 160, 92), (48, 104, 178)
DRONE_COLOUR, POACHER_COLOUR = (236, 164, 40), (34, 38, 43)
_PIXELS = 24
"""Side of a cell."""


def draw_reserve(
    world: Surveillance, drone: int | None = None, poachers: tuple[int, int] | None = None
) -> NDArray[np.uint8]:
    """The reserve: base red, targets green, hilltops blue, as in the thesis.

    Parameters
    ----------
    world : Surveillance
    drone : int, optional
        Target last surveyed, ringed in amber.
    poachers : (row, column), optional
        Where they are: a dark disc.

    Returns
    -------
    picture : (624, 624, 3) uint8
    """
    cells = np.empty((SIDE, SIDE, 3), np.uint8)
    cells[:] = GROUND_COLOUR
    cells[tuple(world.targets.T)] = TARGET_COLOUR
    cells[tuple(world.targets[world.is_hilltop].T)] = HILL_COLOUR
    cells[BASE] = BASE_COLOUR
    picture = cells.repeat(_PIXELS, axis=0).repeat(_PIXELS, axis=1)
    picture[::_PIXELS] = picture[:, ::_PIXELS] = LINE_COLOUR
    if poachers is not None:
        _paint(picture, poachers, 0.0, 0.27, POACHER_COLOUR)
    if drone is not None:
        row, column = world.targets[drone]
        _paint(picture, (int(row), int(column)), 0.34, 0.48, DRONE_COLOUR)
    return picture


def _paint(picture: NDArray[np.uint8], cell: tuple[int, int], inner: float, outer: float, colour) -> None:
    """A ring between two radii, in sides of a cell, around its centre."""
    offset = np.arange(_PIXELS) - (_PIXELS - 1) / 2
    radius = np.hypot(offset[:, None], offset) / _PIXELS
    top, left = (_PIXELS * part for part in cell)
    picture[top : top + _PIXELS, left : left + _PIXELS][(radius >= inner) & (radius <= outer)] = colour
