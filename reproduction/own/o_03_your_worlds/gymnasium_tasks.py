"""Worlds of Gymnasium whose tasks differ: frozen lakes, cliff walks, Taxi; carts with poles, acrobots."""

from collections.abc import Sequence
from functools import cache
from typing import Any

import gymnasium
import numpy as np
from gymnasium.envs.toy_text.frozen_lake import generate_random_map
from gymnasium.wrappers import TransformObservation
from numpy.typing import NDArray
from scipy import ndimage

from lifelore.core.streams import stream

CART_BINS = ([-0.8, 0.8], [-0.5, 0.5], [-0.105, -0.0175, 0.0, 0.0175, 0.105], [-0.87, 0.87])
"""Limits of the bins of position (m), speed (m/s), angle (rad) and its speed (rad/s), after Barto and Sutton."""
ANGLES = [-2.0, -1.0, -0.3, 0.3, 1.0, 2.0]
SPEEDS = [-2.0, -0.5, 0.5, 2.0]
"""Limits of the bins of Acrobot's two angles (rad) and their speeds (rad/s)."""


def cart_pole(number: int) -> gymnasium.Env:
    """A cart and pole of random length, masses and force; observes the bins."""
    env = gymnasium.make("CartPole-v1")
    body: Any = env.unwrapped
    random = stream(number, "O3", "cart pole")
    body.length, body.masspole, body.force_mag = random.uniform((0.25, 0.05, 6.0), (1.5, 0.4, 14.0)).tolist()
    body.total_mass, body.polemass_length = body.masspole + body.masscart, body.masspole * body.length

    def look(seen: NDArray[np.float32]) -> tuple[int, ...]:
        return _bins(seen, CART_BINS)

    return TransformObservation(env, look, None)


def acrobot(number: int) -> gymnasium.Env:
    """An acrobot whose two links have random masses and lengths; observes the bins."""
    env = gymnasium.make("Acrobot-v1")
    body: Any = env.unwrapped
    sizes = stream(number, "O3", "acrobot").uniform((0.8, 0.8, 0.8, 0.8), (1.2, 1.2, 1.2, 1.2)).tolist()
    body.LINK_MASS_1, body.LINK_MASS_2, body.LINK_LENGTH_1, body.LINK_LENGTH_2 = sizes
    body.LINK_COM_POS_1, body.LINK_COM_POS_2 = body.LINK_LENGTH_1 / 2, body.LINK_LENGTH_2 / 2

    def look(seen: NDArray[np.float32]) -> tuple[int, ...]:
        cos_1, sin_1, cos_2, sin_2, speed_1, speed_2 = seen.tolist()
        angles = np.arctan2(sin_1, cos_1), np.arctan2(sin_2, cos_2)
        return _bins((*angles, speed_1, speed_2), (ANGLES, ANGLES, SPEEDS, SPEEDS))

    return TransformObservation(env, look, None)


def _bins(values: Sequence[float] | NDArray[np.float32], limits: Sequence[Sequence[float]]) -> tuple[int, ...]:
    """The number of each value's bin."""
    return tuple(int(np.searchsorted(own, value)) for own, value in zip(limits, values, strict=True))


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
