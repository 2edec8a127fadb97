"""Frozen lakes of Gymnasium with a hidden slip: how often a step goes where it was meant to."""

from functools import partial
from typing import Any

import gymnasium
import numpy as np
from gymnasium.envs.toy_text.frozen_lake import generate_random_map

from reproduction.chapter5.c5_10_one_life.worlds.family import Family

SIDE = 4
SUCCESS = {"dry": 1.0, "wet": 2 / 3, "icy": 1 / 3}
"""Probability that a step goes where it was meant to, else aside; 1/3 is Gymnasium's own."""


def make(slip: str, seed: int) -> gymnasium.Env:
    """The lake of a life, under a slip; it observes the place and the nine tiles around it."""
    tiles = generate_random_map(SIDE, seed=seed)
    env = gymnasium.make("FrozenLake-v1", desc=tiles, success_rate=SUCCESS[slip], disable_env_checker=True)
    codes = np.array([["?SFHG".index(tile) for tile in row] for row in tiles])
    around = np.pad(codes, 1)
    seen = [(place, *around[place // SIDE :, place % SIDE :][:3, :3].ravel().tolist()) for place in range(SIDE**2)]
    space = gymnasium.spaces.MultiDiscrete([SIDE**2] + [5] * 9)
    return gymnasium.wrappers.TransformObservation(env, partial(_look, np.array(seen)), space)


def _look(seen: Any, place: int) -> Any:
    return seen[place].copy()


def state(observation: Any) -> int:
    """The place."""
    return int(observation[0])


def features(observation: Any) -> tuple[int, ...]:
    """The tiles around: a code for outside, start, ice, hole and goal."""
    return tuple(observation[1:].tolist())


SLIPPERY_LAKE = Family(tuple(SUCCESS), make, state, features, episodes=40)
