"""Thirteen worlds of Gymnasium, MiniGrid and our own, each with tasks that differ, states and contexts.

The contexts were written down once, from the meaning of each world, and not tuned: the surroundings of the agent,
and in Taxi the direction of the next stop.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import gymnasium

from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld
from reproduction.own.o_03_your_worlds.grids import NineByNine, whole_grid
from reproduction.own.o_03_your_worlds.gymnasium_tasks import acrobot, cart_pole, cliff, lake, taxi_context


class YourWorld(NamedTuple):
    """A world and the size of its tasks.

    make : number of the life to the world of that life
    episodes, max_steps : of a task
    different : settings of `live_in` that differ from its defaults
    """

    make: Callable[[int], GymnasiumWorld]
    episodes: int
    max_steps: int
    different: Mapping[str, float] = MappingProxyType({})


def _drawn(env: Callable[[int], gymnasium.Env], life: int, **settings: Any) -> GymnasiumWorld:
    """A world whose task t of life n is number 1000 n + t."""
    return GymnasiumWorld(lambda task: env(1000 * life + task), seed=life, **settings)


def _grid(code: str, life: int) -> GymnasiumWorld:
    return GymnasiumWorld(whole_grid(code), seed=life, **_PARTS)


def _taxi(life: int) -> GymnasiumWorld:
    return GymnasiumWorld(gymnasium.make("Taxi-v4"), context=taxi_context, seed=life)


_PARTS: dict[str, Any] = {"state": lambda seen: seen[0], "context": lambda seen: seen[1]}
_SLOWLY = {"learning_rate": 0.1}
"""The learning rate where outcomes are uncertain."""
WORLDS = {
    "DoorKey 5 × 5": YourWorld(lambda n: _grid("DoorKey-5x5", n), 100, 250),
    "MultiRoom, 2 rooms": YourWorld(lambda n: _grid("MultiRoom-N2-S4", n), 150, 40),
    "FourRooms": YourWorld(lambda n: _grid("FourRooms", n), 150, 100),
    "Empty 6 × 6": YourWorld(lambda n: _grid("Empty-Random-6x6", n), 150, 100),
    "KeyCorridor": YourWorld(lambda n: _grid("KeyCorridorS3R1", n), 100, 250),
    "Taxi": YourWorld(_taxi, 150, 200),
    "CliffWalking": YourWorld(lambda n: _drawn(cliff, n, **_PARTS), 150, 200),
    "FrozenLake": YourWorld(lambda n: _drawn(lambda t: lake(t, 6, False), n, **_PARTS), 300, 100),
    "FrozenLake, slippery": YourWorld(
        lambda n: _drawn(lambda t: lake(t, 4, True), n, **_PARTS), 300, 100, _SLOWLY
    ),
    "FrozenLake 6 × 6, slippery": YourWorld(
        lambda n: _drawn(lambda t: lake(t, 6, True), n, **_PARTS), 300, 200, _SLOWLY
    ),
    "grid 9 × 9": YourWorld(lambda n: _drawn(NineByNine, n, **_PARTS), 150, 200),
    "CartPole, binned": YourWorld(
        lambda n: _drawn(cart_pole, n, context=lambda seen: seen[2:], reset_by="episode"), 150, 200,
        _SLOWLY | {"discount": 0.99},
    ),
    "Acrobot, binned": YourWorld(
        lambda n: _drawn(acrobot, n, context=lambda seen: seen[2:], reset_by="episode"), 40, 500,
        _SLOWLY | {"discount": 0.99},
    ),
}  # fmt: skip
"""Name → world."""
