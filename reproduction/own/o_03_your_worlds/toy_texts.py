"""Worlds of Gymnasium's toy texts whose tasks differ: frozen lakes, cliff walks, Taxi."""

from functools import cache
from typing import Any

import gymnasium
import numpy as np
from gymnasium.envs.toy_text.frozen_lake import generate_random_map
from gymnasium.wrappers import TransformObservation
from numpy.typing import NDArray
from scipy import ndimage

from lifelore.core.streams import stream

CLIFF_SHARE = 0.25
"""Share of the cells of a cliff walk that are cliff."""
CLIFF, EDGE, GOAL = 1, 2, 3
MOVES = ((-1, 0), (0, 1), (1, 0), (0, -1))
"""Row and column of CliffWalking's actions: up, right, down, left."""


def lake(number: int, size: int, slippery: bool) -> gymnasium.Env:
    """A random lake of `size` × `size` tiles; observes the place and the nine tiles around it."""
    env = gymnasium.make("FrozenLake-v1", desc=generate_random_map(size, seed=number), is_slippery=slippery)
    tiles = np.pad(env.unwrapped.desc, 1)  # pyright: ignore[reportAttributeAccessIssue]

    def look(place: int) -> tuple[int, bytes]:
        return place, tiles[place // size :, place % size :][:3, :3].tobytes()

    return TransformObservation(env, look, None)


def cliff(number: int) -> gymnasium.Env:
    """A cliff walk whose cells of cliff, start in the first column and goal in the last column are random.

    It observes the place and the four cells around it.
    """
    env = gymnasium.make("CliffWalking-v1")
    random = stream(number, "O3", "cliff")
    while True:
        shape = env.unwrapped.shape  # pyright: ignore[reportAttributeAccessIssue]
        kinds = np.where(random.random(shape) < CLIFF_SHARE, CLIFF, 0)
        start, goal = (int(random.integers(shape[0])), 0), (int(random.integers(shape[0])), shape[1] - 1)
        kinds[start], kinds[goal] = 0, GOAL
        parts = ndimage.label(kinds != CLIFF)[0]  # type: ignore[index]
        if parts[start] == parts[goal]:
            break
    _set_cliff(env.unwrapped, kinds, start)
    around = np.pad(kinds, 1, constant_values=EDGE)

    def look(place: int) -> tuple[int, tuple[int, ...]]:
        row, column = divmod(int(place), shape[1])
        return int(place), tuple(int(around[row + 1 + down, column + 1 + right]) for down, right in MOVES)

    return TransformObservation(env, look, None)


def _set_cliff(env: Any, kinds: NDArray[np.int64], start: tuple[int, int]) -> None:
    """Write CliffWalking's transitions for other cells: a step costs 1, a fall 100 and the way back."""
    last = np.array(kinds.shape) - 1
    first = int(np.ravel_multi_index(start, kinds.shape))
    for cell in np.ndindex(kinds.shape):
        for action, move in enumerate(MOVES):
            row, column = np.clip(np.array(cell) + move, 0, last)
            place = int(np.ravel_multi_index((row, column), kinds.shape))
            kind = kinds[row, column]
            outcome = (1.0, first, -100, False) if kind == CLIFF else (1.0, place, -1, bool(kind == GOAL))
            env.P[int(np.ravel_multi_index(cell, kinds.shape))][action] = [outcome]
    env.initial_state_distrib = np.eye(kinds.size)[first]


@cache
def _taxi() -> Any:
    return gymnasium.make("Taxi-v4").unwrapped


def taxi_context(place: int) -> tuple:
    """Whether the passenger is in the taxi, the direction of the next stop, and which moves a wall stops."""
    env = _taxi()
    row, column, passenger, destination = env.decode(place)
    there = env.locs[destination if passenger == 4 else passenger]
    stopped = tuple(env.P[place][move][0][1] == place for move in range(4))
    return passenger == 4, int(np.sign(there[0] - row)), int(np.sign(there[1] - column)), stopped
