"""A MiniGrid environment in a fixed layout with several goals, of which a hidden preference wants one."""

from collections.abc import Callable, Mapping, Sequence
from itertools import count
from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Discrete, MultiDiscrete
from minigrid.core.constants import OBJECT_TO_IDX
from minigrid.core.world_object import Goal

from lifelore.core.errors import InputError

Cell = tuple[int, int]
ACTIONS = (0, 1, 2, 3, 5)
"""Left, right, forward, pick up, toggle: the actions of MiniGrid that do something here."""
AHEAD = ((1, 0), (0, 1), (-1, 0), (0, -1))
"""The step ahead by direction, in columns and rows."""
LAYOUTS = 1000
"""Layouts that a life may choose from."""


class GridPreference(gymnasium.Wrapper):
    """The same layout in every episode; the wanted goal pays 1, any goal ends the episode.

    ## Action Space
    ``Discrete(5)``, see `ACTIONS`.

    ## Observation Space
    ``MultiDiscrete``: column, row and direction; whether a key is carried; how many doors are open; and the kinds
    of what is ahead, to the left, and to the right.

    Parameters
    ----------
    env : gymnasium.Env
        Of MiniGrid.
    layout : int
        Seed of the layout.
    goals : mapping of str to cell
        Columns and rows by preference.
    starts : sequence of cell
        Where episodes start, in any direction.
    wanted : str
        The preference.
    """

    def __init__(
        self, env: gymnasium.Env, layout: int, goals: Mapping[str, Cell], starts: Sequence[Cell], wanted: str
    ) -> None:
        super().__init__(env)
        self.base: Any = env.unwrapped
        self.base.gen_obs = dict  # the agent's own view goes unused, and drawing it takes most of a step
        self.layout, self.goals, self.starts, self.wanted = layout, goals, starts, goals[wanted]
        self.action_space = Discrete(len(ACTIONS))
        kinds = [len(OBJECT_TO_IDX)] * 3
        self.observation_space = MultiDiscrete([self.base.width, self.base.height, 4, 2, 3, *kinds])
        self._doors: list[Any] = []

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None):
        """Start in one of the starts; `seed` decides in which, and in which direction."""
        base = self.base
        own = base.np_random if seed is None else np.random.default_rng(seed)
        super().reset(seed=self.layout)
        base.np_random, cells = own, base.grid.grid
        for place, one in enumerate(cells):
            if one is not None and one.type == "goal":
                cells[place] = None
        for cell in self.goals.values():
            base.grid.set(*cell, Goal())
        self._doors = [one for one in cells if one is not None and one.type == "door"]
        base.agent_pos = self.starts[int(own.integers(len(self.starts)))]
        base.agent_dir = int(own.integers(4))
        return self._seen(), {}

    def step(self, action: Any):
        """One action; a goal ends the episode, and only the wanted one pays."""
        _, _, ended, truncated, info = self.env.step(ACTIONS[int(action)])
        paid = float(ended and tuple(self.base.agent_pos) == self.wanted)
        return self._seen(), paid, ended, truncated, info

    def _seen(self) -> Any:
        base = self.base
        (x, y), facing = base.agent_pos, base.agent_dir
        kinds = []
        for turn in (0, 3, 1):
            right, down = AHEAD[(facing + turn) % 4]
            thing = base.grid.get(x + right, y + down)
            kinds.append(1 if thing is None else OBJECT_TO_IDX[thing.type])
        n_open = sum(door.is_open for door in self._doors)
        return np.array([x, y, facing, base.carrying is not None, n_open, *kinds], np.int64)


def free_cells(base: Any, top: Cell, size: Cell) -> list[Cell]:
    """Cells without anything in a room of MiniGrid, walls included in its size."""
    columns, rows = range(top[0] + 1, top[0] + size[0] - 1), range(top[1] + 1, top[1] + size[1] - 1)
    return [(x, y) for x in columns for y in rows if base.grid.get(x, y) is None]


def preferring(
    env: gymnasium.Env,
    places: Callable[[Any], tuple[Mapping[str, Cell], list[Cell]] | None],
    seed: int,
    wanted: str,
) -> GridPreference:
    """The environment in the first layout of a life that has room for all goals.

    Parameters
    ----------
    places : callable
        ``places(base)``: goals by preference and starts in the current layout; None where a goal finds no room.
    seed : int
        Of the life.
    """
    base: Any = env.unwrapped
    for layout in count(LAYOUTS * seed):
        env.reset(seed=layout)
        found = places(base)
        if found is not None:
            return GridPreference(env, layout, *found, wanted)
    raise InputError("places must find room in some layout")


def state(observation: Any) -> tuple[int, ...]:
    """Pose, key and door."""
    return tuple(observation[:5].tolist())


def features(observation: Any) -> tuple[int, ...]:
    """Key, door, and what is around."""
    return tuple(observation[3:].tolist())
