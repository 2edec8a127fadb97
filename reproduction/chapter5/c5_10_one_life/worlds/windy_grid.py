"""Windy grid of Sutton and Barto (2018, Example 6.5) with a hidden wind.

Source: Sutton and Barto (2018), Reinforcement Learning, 2nd edition; gusts are those of Exercise 6.10.
"""

from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Discrete

from lifelore.core.streams import stream
from reproduction.chapter5.c5_10_one_life.worlds.family import Family

ROWS, COLUMNS, GOAL_COLUMN = 7, 10, 7
STRENGTH = (0, 0, 0, 1, 1, 1, 2, 2, 1, 0)
"""Rows that the wind carries the agent, by the column that it leaves."""
MOVES = ((-1, 0), (0, 1), (1, 0), (0, -1))
"""North, east, south, west, in rows and columns."""
WINDS = {"calm": 0, "south wind": -1, "north wind": 1, "gusts": -1}
"""Direction of the wind in rows by type; gusts also carry a row more or less, each in a third of the moves."""


class WindyGrid(gymnasium.Env):
    """A walk to the goal; −1 a move until it is reached.

    ## Action Space
    ``Discrete(4)``: north, east, south, west.

    ## Observation Space
    ``Discrete(70)``: row · 10 + column.

    ## Starting State
    Any row of the first column.

    ## Arguments
    `wind`: of `WINDS`. `goal_row`: the goal lies in it and in column 7.
    """

    def __init__(self, wind: str, goal_row: int) -> None:
        self.wind, self.gusts = WINDS[wind], wind == "gusts"
        self.goal = goal_row, GOAL_COLUMN
        self.action_space = Discrete(len(MOVES))
        self.observation_space = Discrete(ROWS * COLUMNS)
        self.place = (0, 0)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None):
        """Start in a row of the first column."""
        super().reset(seed=seed)
        self.place = int(self.np_random.integers(ROWS)), 0
        return self._seen(), {}

    def step(self, action: Any):
        """Move and be carried, inside the grid."""
        (row, column), (down, right) = self.place, MOVES[int(action)]
        carried = self.wind * STRENGTH[column]
        if self.gusts and carried:
            carried += int(self.np_random.integers(-1, 2))
        row = min(max(row + down + carried, 0), ROWS - 1)
        self.place = row, min(max(column + right, 0), COLUMNS - 1)
        return self._seen(), -1.0, self.place == self.goal, False, {}

    def _seen(self) -> int:
        return self.place[0] * COLUMNS + self.place[1]


def make(wind: str, seed: int) -> WindyGrid:
    """The grid of a life: its goal lies in one of the three middle rows."""
    return WindyGrid(wind, int(stream(seed, "C5.10", "windy grid").integers(2, 5)))


def features(place: Any) -> tuple[int, bool, bool]:
    """The direction of the goal's column, and whether the upper or the lower border is near."""
    row, column = divmod(int(place), COLUMNS)
    return int(np.sign(GOAL_COLUMN - column)), row == 0, row == ROWS - 1


WINDY_GRID = Family(tuple(WINDS), make, int, features, learner="model")
