"""Pictures of the ball game in the colours of the thesis's Figure 4.14: RGB arrays from NumPy alone."""

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.ball_game.ball_game import SIDE, BallGame

OBSTACLE_COLOUR, FREE_COLOUR = (58, 92, 168), (255, 255, 255)
GOAL_COLOUR, BALL_COLOUR = (38, 145, 104), (206, 52, 46)
UNITS = 2
"""Units of the field a pixel."""


def draw_ball_game(game: BallGame) -> NDArray[np.uint8]:
    """The field with obstacles in blue, the goal in green, and the largest ball in red; (501, 501, 3) uint8."""
    picture = np.full((SIDE // UNITS + 1, SIDE // UNITS + 1, 3), FREE_COLOUR, np.uint8)
    left, top, right, bottom = (bound // UNITS for bound in game.layout.goal)
    picture[top : bottom + 1, left : right + 1] = GOAL_COLOUR
    picture[game.field.clearance[::UNITS, ::UNITS] == 0] = OBSTACLE_COLOUR
    x, y = game.layout.start
    pixels = UNITS * np.arange(len(picture))
    # Small balls are drawn large enough to be seen.
    reach = max(float(game.field.radius[game.n_types - 1]), 2.5 * UNITS)
    picture[(pixels - x) ** 2 + (pixels[:, None] - y) ** 2 <= reach**2] = BALL_COLOUR
    return picture
