"""A small windy grid whose wind is hidden, for tests of the agent for anyone's tasks."""

import gymnasium
import numpy as np


class WindyGrid(gymnasium.Env):
    """Five rows and six columns; the wind pushes by `wind` rows in the middle columns, nine times in ten."""

    def __init__(self, wind: int) -> None:
        self.wind = wind
        self.observation_space = gymnasium.spaces.MultiDiscrete([5, 6])
        self.action_space = gymnasium.spaces.Discrete(4)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.place = (int(self.np_random.integers(5)), 0)
        return np.array(self.place), {}

    def step(self, action):
        down, right = ((-1, 0), (1, 0), (0, -1), (0, 1))[action]
        row, column = self.place
        push = self.wind if 2 <= column <= 3 and self.np_random.random() < 0.9 else 0
        self.place = (min(4, max(0, row + down + push)), min(5, max(0, column + right)))
        ended = self.place == (2, 5)
        return np.array(self.place), 10.0 if ended else -1.0, ended, False, {}


SETTINGS = {
    "key": "windy grid",
    "state": lambda seen: tuple(seen.tolist()),
    "features": lambda seen: int(np.sign(seen[0] - 2)),
    "episodes": 15,
    "max_steps": 60,
}
WINDS = (-1, 1)
