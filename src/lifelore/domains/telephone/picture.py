"""Pictures of a call: the six states of Figure 4.5, and where the caller is; RGB arrays from NumPy alone."""

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.telephone.telephone import ANGRY, HUNG_UP, OPEN, STATES, SUCCESS

PAPER_COLOUR, LINE_COLOUR, RIM_COLOUR = (255, 255, 255), (190, 196, 203), (89, 97, 107)
STATE_COLOURS = (
    (214, 230, 244),
    (250, 226, 170),
    (244, 190, 130),
    (222, 120, 100),
    (150, 206, 160),
    (170, 170, 176),
)
HERE_COLOUR = (34, 38, 43)
PLACES = ((80, 160), (230, 160), (380, 160), (530, 160), (305, 50), (305, 270))
"""Column and row of each state's centre, in pixels."""
_SIZE = (320, 610)
_RADIUS = 34


def draw_call(state: int) -> NDArray[np.uint8]:
    """The states as discs in their order, those that end the call with a thick rim, a dark dot in the current one.

    Left to right: start, frustrated, annoyed, angry; above: success; below: hung up.

    Returns
    -------
    picture : (320, 610, 3) uint8
    """
    picture = np.full((*_SIZE, 3), PAPER_COLOUR, np.uint8)
    for s in OPEN:
        for s2 in (s + 1, SUCCESS, HUNG_UP):
            _draw_line(picture, PLACES[s], PLACES[s2])
    for s in range(len(STATES)):
        rim = 6 if s in (ANGRY, SUCCESS, HUNG_UP) else 2
        _draw_disc(picture, PLACES[s], _RADIUS, RIM_COLOUR)
        _draw_disc(picture, PLACES[s], _RADIUS - rim, STATE_COLOURS[s])
    _draw_disc(picture, PLACES[state], 11, HERE_COLOUR)
    return picture


def _draw_line(picture: NDArray[np.uint8], start: tuple[int, int], end: tuple[int, int]) -> None:
    (x0, y0), (x1, y1) = start, end
    y, x = np.mgrid[: _SIZE[0], : _SIZE[1]]
    length = np.hypot(x1 - x0, y1 - y0)
    along = ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / length
    beside = np.abs((x - x0) * (y1 - y0) - (y - y0) * (x1 - x0)) / length
    picture[(beside <= 1.5) & (along >= 0) & (along <= length)] = LINE_COLOUR


def _draw_disc(picture: NDArray[np.uint8], centre: tuple[int, int], radius: int, colour) -> None:
    y, x = np.ogrid[: _SIZE[0], : _SIZE[1]]
    picture[np.hypot(x - centre[0], y - centre[1]) <= radius] = colour
