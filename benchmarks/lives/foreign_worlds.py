"""Seven worlds of Gymnasium and MiniGrid for `bench worlds`, each with tasks that differ, states and contexts.

The contexts were written down once, from the meaning of each world, and not tuned: the surroundings of the agent,
and in Taxi the direction of the next stop.
"""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import gymnasium
import numpy as np
from gymnasium.envs.toy_text.frozen_lake import generate_random_map
from gymnasium.wrappers import TransformObservation
from numpy.typing import NDArray

from lifelore.bridges.gymnasium_world import GymnasiumWorld
from lifelore.core.streams import stream

LAKE = 4
"""Side of a frozen lake."""
CLIFF_SHARE = 0.25
CLIFF, EDGE, GOAL = 1, 2, 3
MOVES = ((-1, 0), (0, 1), (1, 0), (0, -1))
"""Row and column of CliffWalking's actions: up, right, down, left."""


@dataclass(frozen=True)
class ForeignWorld:
    """A world of other people with the settings of its lives.

    make : run number to `GymnasiumWorld`; each run has other tasks
    tasks : what differs between tasks, in words
    settings : arguments of `live_in`
    """

    make: Callable[[int], GymnasiumWorld]
    tasks: str
    settings: dict[str, Any] = field(default_factory=dict)


# ---- toy texts -----------------------------------------------------------------------------------


def slippery_lake(number: int) -> gymnasium.Env:
    """A random lake; observes the place and the nine tiles around it."""
    env = gymnasium.make("FrozenLake-v1", desc=generate_random_map(LAKE, seed=number), is_slippery=True)
    tiles = np.pad(env.unwrapped.desc, 1)  # pyright: ignore[reportAttributeAccessIssue]

    def look(place: int) -> tuple[int, bytes]:
        return place, tiles[place // LAKE :, place % LAKE :][:3, :3].tobytes()

    return TransformObservation(env, look, None)


def taxi_context(place: int) -> tuple:
    """Whether the passenger is in the taxi, the direction of the next stop, and which moves a wall stops."""
    env = _TAXI.unwrapped
    row, column, passenger, destination = env.decode(place)  # pyright: ignore[reportAttributeAccessIssue]
    there = env.locs[destination if passenger == 4 else passenger]  # pyright: ignore[reportAttributeAccessIssue]
    outcomes = env.P[place]  # pyright: ignore[reportAttributeAccessIssue]
    stopped = tuple(outcomes[move][0][1] == place for move in range(4))
    return passenger == 4, int(np.sign(there[0] - row)), int(np.sign(there[1] - column)), stopped


_TAXI = gymnasium.make("Taxi-v4")


def cliff(number: int) -> gymnasium.Env:
    """A cliff walk whose cells of cliff, start in the first column and goal in the last column are random."""
    env = gymnasium.make("CliffWalking-v1")
    random = stream(number, "bench", "worlds", "cliff")
    while True:
        shape = env.unwrapped.shape  # pyright: ignore[reportAttributeAccessIssue]
        kinds = np.where(random.random(shape) < CLIFF_SHARE, CLIFF, 0)
        start, goal = (int(random.integers(shape[0])), 0), (int(random.integers(shape[0])), shape[1] - 1)
        kinds[start], kinds[goal] = 0, GOAL
        if goal in _reachable(kinds, start):
            break
    _set_cliff(env.unwrapped, kinds, start)
    around = np.pad(kinds, 1, constant_values=EDGE)

    def look(place: int) -> tuple[int, tuple[int, ...]]:
        row, column = divmod(int(place), shape[1])
        return int(place), tuple(int(around[row + 1 + down, column + 1 + right]) for down, right in MOVES)

    return TransformObservation(env, look, None)


def _reachable(kinds: NDArray[np.int64], start: tuple[int, int]) -> set[tuple[int, int]]:
    seen, waiting = {start}, deque([start])
    while waiting:
        row, column = waiting.popleft()
        for down, right in MOVES:
            cell = row + down, column + right
            inside = 0 <= cell[0] < kinds.shape[0] and 0 <= cell[1] < kinds.shape[1]
            if inside and kinds[cell] != CLIFF and cell not in seen:
                seen.add(cell)
                waiting.append(cell)
    return seen


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


# ---- CartPole ------------------------------------------------------------------------------------

BINS = ([-0.8, 0.8], [-0.5, 0.5], [-0.105, -0.0175, 0.0, 0.0175, 0.105], [-0.87, 0.87])
"""Limits of the bins of position (m), speed (m/s), angle (rad) and its speed (rad/s), after Barto and Sutton."""


def cart_pole(number: int) -> gymnasium.Env:
    """A cart and pole of random length, masses and force; observes the bins."""
    env = gymnasium.make("CartPole-v1")
    body: Any = env.unwrapped
    random = stream(number, "bench", "worlds", "cart pole")
    body.length, body.masspole, body.force_mag = random.uniform((0.25, 0.05, 6.0), (1.5, 0.4, 14.0)).tolist()
    body.total_mass, body.polemass_length = body.masspole + body.masscart, body.masspole * body.length
    limits = [np.array(bins) for bins in BINS]

    def look(seen: NDArray[np.float32]) -> tuple[int, ...]:
        return tuple(int(np.searchsorted(bins, value)) for bins, value in zip(limits, seen, strict=True))

    return TransformObservation(env, look, None)


# ---- MiniGrid ------------------------------------------------------------------------------------


class WholeGrid(gymnasium.ObservationWrapper):
    """A MiniGrid environment observed as (state, context), both tuples.

    The state is the pose, and the places and openings of keys and doors. The context: what is in front, to the
    left and to the right, whether a door in front is open, and whether the agent carries a key.
    """

    def __init__(self, env: gymnasium.Env) -> None:
        super().__init__(env)
        self.grid_env: Any = env.unwrapped
        # The agent's own view goes unused here, and drawing it takes three quarters of a step.
        self.grid_env.gen_obs = dict

    def reset(self, **settings: Any) -> tuple[Any, dict[str, Any]]:
        """Reset, and find the objects that can change."""
        _, about = self.env.reset(**settings)
        objects = [thing for thing in self.grid_env.grid.grid if thing is not None]
        self._changing = [thing for thing in objects if thing.type in ("key", "door")]
        return self.observation({}), about

    def observation(self, observation: Any) -> tuple[tuple, tuple]:
        """State and context now."""
        env = self.grid_env
        x, y = (int(part) for part in env.agent_pos)
        facing = int(env.agent_dir)
        # A door never moves and a key never opens.
        things = tuple(
            thing.is_open if thing.type == "door" else tuple(map(int, thing.cur_pos)) for thing in self._changing
        )
        carried = env.carrying is not None
        around = tuple(_kind(env.grid, x, y, (facing + turn) % 4) for turn in (0, 3, 1))
        return (x, y, facing, carried, things), (*around, carried)


def _kind(grid: Any, x: int, y: int, direction: int) -> str:
    down, right = ((0, 1), (1, 0), (0, -1), (-1, 0))[direction]
    thing = grid.get(x + right, y + down)
    if thing is None:
        return "free"
    return f"{thing.type} open" if getattr(thing, "is_open", False) else thing.type


def mini_grid(name: str, run: int) -> GymnasiumWorld:
    """A registered MiniGrid environment (extra ``envs``) whose layouts are drawn from the run's seed."""
    env = gymnasium.make(f"minigrid:MiniGrid-{name}-v0", disable_env_checker=True)
    return GymnasiumWorld(WholeGrid(env), state=_first, context=_second, seed=run)


# ---- the list ------------------------------------------------------------------------------------


def _first(seen: tuple) -> Any:
    return seen[0]


def _second(seen: tuple) -> Any:
    return seen[1]


def _made(env: Callable[[int], gymnasium.Env], run: int, **settings: Any) -> GymnasiumWorld:
    """A world whose task t of run r is number 1000 r + t."""
    return GymnasiumWorld(lambda task: env(1000 * run + task), seed=run, **settings)


WORLDS = {
    "FrozenLake, slippery": ForeignWorld(
        lambda run: _made(slippery_lake, run, state=_first, context=_second),
        "random maps of 4 × 4",
        {"episodes": 300, "max_steps": 100, "learning_rate": 0.1},
    ),
    "Taxi": ForeignWorld(
        lambda run: GymnasiumWorld(gymnasium.make("Taxi-v4"), context=taxi_context, seed=run),
        "places of taxi, passenger and destination",
        {"episodes": 150, "max_steps": 200},
    ),
    "CliffWalking": ForeignWorld(
        lambda run: _made(cliff, run, state=_first, context=_second),
        "cells of cliff, start and goal",
        {"episodes": 150, "max_steps": 200},
    ),
    "DoorKey 5 × 5": ForeignWorld(
        lambda run: mini_grid("DoorKey-5x5", run),
        "places of wall, door, key and agent",
        {"episodes": 100, "max_steps": 250},
    ),
    "MultiRoom, 2 rooms": ForeignWorld(
        lambda run: mini_grid("MultiRoom-N2-S4", run), "rooms, door and goal", {"episodes": 150, "max_steps": 40}
    ),
    "FourRooms": ForeignWorld(
        lambda run: mini_grid("FourRooms", run), "gaps, agent and goal", {"episodes": 150, "max_steps": 100}
    ),
    "CartPole, binned": ForeignWorld(
        lambda run: _made(cart_pole, run, context=lambda seen: seen[2:], reset_by="episode"),
        "length and mass of the pole, force",
        {"episodes": 150, "max_steps": 200, "discount": 0.99, "learning_rate": 0.1},
    ),
}
"""Name to world; the learning rate is 0.5 in worlds whose outcomes are certain and 0.1 in the other two."""
