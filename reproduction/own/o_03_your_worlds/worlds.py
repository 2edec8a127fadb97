"""Six worlds of Gymnasium and MiniGrid, each with tasks that differ, states and contexts.

The contexts were written down once, from the meaning of each world, and not tuned: the surroundings of the agent,
and in Taxi the direction of the next stop.
"""

from collections.abc import Callable
from functools import cache
from typing import Any

import gymnasium
import numpy as np
from gymnasium.envs.toy_text.frozen_lake import generate_random_map
from gymnasium.wrappers import TransformObservation
from numpy.typing import NDArray

from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld
from lifelore.core.streams import stream

LAKE = 4
"""Side of a frozen lake."""
BINS = ([-0.8, 0.8], [-0.5, 0.5], [-0.105, -0.0175, 0.0, 0.0175, 0.105], [-0.87, 0.87])
"""Limits of the bins of position (m), speed (m/s), angle (rad) and its speed (rad/s), after Barto and Sutton."""


def slippery_lake(number: int) -> gymnasium.Env:
    """A random lake; observes the place and the nine tiles around it."""
    env = gymnasium.make("FrozenLake-v1", desc=generate_random_map(LAKE, seed=number), is_slippery=True)
    tiles = np.pad(env.unwrapped.desc, 1)  # pyright: ignore[reportAttributeAccessIssue]

    def look(place: int) -> tuple[int, bytes]:
        return place, tiles[place // LAKE :, place % LAKE :][:3, :3].tobytes()

    return TransformObservation(env, look, None)


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


def cart_pole(number: int) -> gymnasium.Env:
    """A cart and pole of random length, masses and force; observes the bins."""
    env = gymnasium.make("CartPole-v1")
    body: Any = env.unwrapped
    random = stream(number, "O3", "cart pole")
    body.length, body.masspole, body.force_mag = random.uniform((0.25, 0.05, 6.0), (1.5, 0.4, 14.0)).tolist()
    body.total_mass, body.polemass_length = body.masspole + body.masscart, body.masspole * body.length
    limits = [np.array(bins) for bins in BINS]

    def look(seen: NDArray[np.float32]) -> tuple[int, ...]:
        return tuple(int(np.searchsorted(bins, value)) for bins, value in zip(limits, seen, strict=True))

    return TransformObservation(env, look, None)


def whole_grid(name: str) -> gymnasium.Env:
    """A MiniGrid environment (extra ``envs``) that observes state and context.

    The state is the pose, and the places and openings of keys and doors. The context: what is in front, to the
    left and to the right, whether a door there is open, and whether the agent carries a key.
    """
    env = gymnasium.make(f"minigrid:MiniGrid-{name}-v0", disable_env_checker=True)
    base: Any = env.unwrapped
    base.gen_obs = dict  # the agent's own view goes unused, and drawing it takes three quarters of a step

    def look(_: Any) -> tuple[tuple, tuple]:
        x, y = (int(part) for part in base.agent_pos)
        facing, carried = int(base.agent_dir), base.carrying is not None
        things = enumerate(base.grid.grid)
        changing = tuple(
            (n, getattr(one, "is_open", 0)) for n, one in things if one and one.type in ("key", "door")
        )
        around = tuple(_kind(base.grid, x, y, (facing + turn) % 4) for turn in (0, 3, 1))
        return (x, y, facing, carried, changing), (*around, carried)

    return TransformObservation(env, look, None)


def _kind(grid: Any, x: int, y: int, direction: int) -> str:
    down, right = ((0, 1), (1, 0), (0, -1), (-1, 0))[direction]
    thing = grid.get(x + right, y + down)
    return "free" if thing is None else f"{thing.type} {getattr(thing, 'is_open', '')}"


def _drawn(env: Callable[[int], gymnasium.Env], life: int, **settings: Any) -> GymnasiumWorld:
    """A world whose task t of life n is number 1000 n + t."""
    return GymnasiumWorld(lambda task: env(1000 * life + task), seed=life, **settings)


_PARTS: dict[str, Any] = {"state": lambda seen: seen[0], "context": lambda seen: seen[1]}
_GRIDS = {
    "DoorKey 5 × 5": ("DoorKey-5x5", 100, 250), "MultiRoom, 2 rooms": ("MultiRoom-N2-S4", 150, 40),
    "FourRooms": ("FourRooms", 150, 100),
}  # fmt: skip
_SLOWLY = {"learning_rate": 0.1}
WORLDS: dict[str, tuple[Callable[[int], GymnasiumWorld], int, int, dict[str, float]]] = {
    name: (lambda n, code=code: GymnasiumWorld(whole_grid(code), seed=n, **_PARTS), episodes, steps, {})
    for name, (code, episodes, steps) in _GRIDS.items()
} | {
    "Taxi": (
        lambda n: GymnasiumWorld(gymnasium.make("Taxi-v4"), context=taxi_context, seed=n), 150, 200, {},
    ),
    "FrozenLake, slippery": (lambda n: _drawn(slippery_lake, n, **_PARTS), 300, 100, _SLOWLY),
    "CartPole, binned": (
        lambda n: _drawn(cart_pole, n, context=lambda seen: seen[2:], reset_by="episode"), 150, 200,
        _SLOWLY | {"discount": 0.99},
    ),
}  # fmt: skip
"""Name → the world of a life, episodes of a task, most steps, and what differs from the defaults of `live_in`: the
learning rate is 0.1 where outcomes are uncertain."""
