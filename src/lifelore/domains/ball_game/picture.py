"""Pictures of the ball game in the colours of the thesis's Figure 4.14: RGB arrays from NumPy alone."""

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.domains.ball_game.ball_game import SIDE, BallGame

OBSTACLE_COLOUR, FREE_COLOUR = (58, 92, 168), (255, 255, 255)
GOAL_COLOUR, BALL_COLOUR, TRAIL_COLOUR = (38, 145, 104), (206, 52, 46), (226, 150, 146)
UNITS = 2
"""Units of the field a pixel."""


def draw_ball_game(
    game: BallGame,
    kind: int | None = None,
    place: tuple[int, int] | None = None,
    trail: ArrayLike | None = None,
) -> NDArray[np.uint8]:
    """The field with obstacles in blue, the goal in green, and the ball in red.

    Parameters
    ----------
    game : BallGame
    kind : int, optional
        Number of the ball's size; the largest if left out.
    place : (x, y), optional
        Of the ball's centre; the start if left out.
    trail : (n, 2) int, optional
        Places where it has been, joined by lines along the axes.

    Returns
    -------
    picture : (501, 501, 3) uint8
    """
    kind = game.n_types - 1 if kind is None else kind
    if not 0 <= kind < game.n_types:
        raise InputError(f"kind must lie in [0, {game.n_types}), got {kind}")
    picture = np.full((SIDE // UNITS + 1, SIDE // UNITS + 1, 3), FREE_COLOUR, np.uint8)
    left, top, right, bottom = (bound // UNITS for bound in game.layout.goal)
    picture[top : bottom + 1, left : right + 1] = GOAL_COLOUR
    picture[game.field.clearance[::UNITS, ::UNITS] == 0] = OBSTACLE_COLOUR
    if trail is not None:
        _draw_trail(picture, np.asarray(trail, int) // UNITS)
    _draw_ball(picture, game.layout.start if place is None else place, float(game.field.radius[kind]))
    return picture


def _draw_ball(picture: NDArray[np.uint8], place: tuple[int, int], radius: float) -> None:
    pixels = UNITS * np.arange(len(picture))
    # Small balls are drawn large enough to be seen.
    reach = max(radius, 2.5 * UNITS)
    disc = (pixels - place[0]) ** 2 + (pixels[:, None] - place[1]) ** 2 <= reach**2
    picture[disc] = BALL_COLOUR


def _draw_trail(picture: NDArray[np.uint8], trail: NDArray[np.int64]) -> None:
    for (x0, y0), (x1, y1) in pairwise(trail):
        columns, rows = sorted((x0, x1)), sorted((y0, y1))
        picture[y0, columns[0] : columns[1] + 1] = TRAIL_COLOUR
        picture[rows[0] : rows[1] + 1, x1] = TRAIL_COLOUR
