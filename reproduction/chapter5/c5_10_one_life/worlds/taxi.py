"""Taxi of Gymnasium with a hidden destination: the passenger is seen, but not where to."""

from functools import cache
from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Discrete

from reproduction.chapter5.c5_10_one_life.worlds.family import Family

STOPS = {"red": 0, "green": 1, "yellow": 2, "blue": 3}
"""Gymnasium's numbers of the stops, by the colour of the destination."""
ON_BOARD = 4
"""Place of a passenger who is in the taxi."""
MAX_STEPS = 60


class HiddenDestination(gymnasium.Wrapper):
    """Taxi with one destination, which the observation leaves out.

    ## Observation Space
    ``Discrete(125)``: (row · 5 + column) · 5 + place of the passenger.

    ## Starting State
    The taxi anywhere, the passenger at any stop but the destination.
    """

    def __init__(self, env: gymnasium.Env, destination: int) -> None:
        super().__init__(env)
        self.base: Any = env.unwrapped
        self.observation_space = Discrete(125)
        possible = np.flatnonzero(self.base.initial_state_distrib)
        self._starts = possible[possible % len(STOPS) == destination]

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None):
        """Start with the destination of this task."""
        super().reset(seed=seed)
        self.base.s = int(self._starts[self.base.np_random.integers(len(self._starts))])
        return self.base.s // len(STOPS), {}

    def step(self, action: Any):
        """One action of Taxi."""
        place, paid, ended, truncated, _ = self.env.step(int(action))
        return place // len(STOPS), float(paid), ended, truncated, {}


@cache
def _taxi() -> Any:
    return gymnasium.make("Taxi-v4", disable_env_checker=True).unwrapped


def make(destination: str, seed: int) -> gymnasium.Env:
    """Taxi to a destination; the map is the same in every life."""
    env = gymnasium.make("Taxi-v4", max_episode_steps=MAX_STEPS, disable_env_checker=True)
    return HiddenDestination(env, STOPS[destination])


@cache
def features(place: int) -> tuple:
    """Who is on board, the direction of a waiting passenger, the stop that the taxi is at, and walls around."""
    taxi = _taxi()
    whole = place * len(STOPS)
    row, column, passenger, _ = taxi.decode(whole)
    walls = tuple(taxi.P[whole][move][0][1] == whole for move in range(4))
    here = (row, column) in taxi.locs
    if passenger == ON_BOARD:
        return True, here, walls
    there = taxi.locs[passenger]
    return False, here, int(np.sign(there[0] - row)), int(np.sign(there[1] - column)), walls


TAXI = Family(tuple(STOPS), make, int, features, max_steps=MAX_STEPS)
