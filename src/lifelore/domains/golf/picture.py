"""Pictures of a hole and the shots at it: RGB arrays from NumPy alone."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.golf.golf import EDGES

SKY_COLOUR, GRASS_COLOUR, ROUGH_COLOUR = (226, 240, 248), (118, 178, 96), (150, 198, 124)
FLAG_COLOUR, POLE_COLOUR, TEE_COLOUR = (205, 62, 56), (60, 64, 70), (60, 64, 70)
BALL_COLOUR, LAST_COLOUR, RIM_COLOUR = (255, 255, 255), (236, 164, 40), (70, 90, 60)
_WIDTH, _HEIGHT, _GROUND = 720, 200, 130
_MARGIN, _BALL = 20, 6
_LONGEST = 280.0
"""Yards from the tee to the right edge; balls and flags beyond are drawn at the edge."""


def draw_hole(distance: float, landed: Sequence[float] = ()) -> NDArray[np.uint8]:
    """The course from the side: tee, flag, a band of grass for each category of error, and where balls landed.

    Parameters
    ----------
    distance : float
        Of the hole, yards from the tee.
    landed : sequence of float
        Yards from the tee, in order; the last is amber.

    Returns
    -------
    picture : (200, 720, 3) uint8
    """
    picture = np.empty((_HEIGHT, _WIDTH, 3), np.uint8)
    picture[:_GROUND] = SKY_COLOUR
    bands = np.searchsorted([_column(distance + edge) for edge in EDGES], np.arange(_WIDTH), side="right")
    picture[_GROUND:] = np.where((bands % 2 == 1)[:, None], GRASS_COLOUR, ROUGH_COLOUR)
    _fill(picture, _GROUND - 6, _GROUND, _column(0) - 3, _column(0) + 3, TEE_COLOUR)
    pole = _column(distance)
    _fill(picture, _GROUND - 74, _GROUND, pole - 1, pole + 1, POLE_COLOUR)
    _fill(picture, _GROUND - 74, _GROUND - 52, pole + 1, pole + 30, FLAG_COLOUR)
    for shot, yards in enumerate(landed):
        _draw_ball(picture, _column(yards), LAST_COLOUR if shot == len(landed) - 1 else BALL_COLOUR)
    return picture


def _column(yards: float) -> int:
    place = _MARGIN + yards / _LONGEST * (_WIDTH - 2 * _MARGIN)
    return int(np.clip(round(place), _MARGIN, _WIDTH - _MARGIN))


def _fill(picture: NDArray[np.uint8], top: int, bottom: int, left: int, right: int, colour) -> None:
    picture[top:bottom, max(0, left) : right] = colour


def _draw_ball(picture: NDArray[np.uint8], column: int, colour) -> None:
    y, x = np.ogrid[:_HEIGHT, :_WIDTH]
    radius = np.hypot(y - (_GROUND + 22), x - column)
    picture[radius <= _BALL + 1.5] = RIM_COLOUR
    picture[radius <= _BALL] = colour
