"""Grids: those of MiniGrid with state and context, and a grid of 9 × 9 cells as a user would write one."""

from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Discrete, Tuple
from gymnasium.wrappers import TransformObservation

from lifelore.core.streams import stream

SIZE = 9
WALLS = 0.2
"""Share of the cells of `NineByNine` that are walls."""
STEPS = ((-1, 0), (0, 1), (1, 0), (0, -1))
"""Row and column of the actions of `NineByNine`: up, right, down, left."""


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


class NineByNine(gymnasium.Env):
    """A grid with random walls, start and goal: a step costs 0.1, the goal gives 10 and ends the episode.

    Observes the cell (row, column) and which of its four neighbours are walls. The start may be cut off from the
    goal; an episode then ends by the most steps.
    """

    def __init__(self, number: int) -> None:
        random = stream(number, "O3", "nine by nine")
        self.walls = np.pad(random.random((SIZE, SIZE)) < WALLS, 1, constant_values=True)
        free = np.argwhere(~self.walls)
        start, goal = free[random.choice(len(free), 2, replace=False)].tolist()
        self.start, self.goal = tuple(start), tuple(goal)
        cells = Discrete(SIZE + 2)
        self.action_space = Discrete(len(STEPS))
        self.observation_space = Tuple((Tuple((cells, cells)), Tuple([Discrete(2)] * len(STEPS))))

    def reset(self, *, seed: int | None = None, options: dict | None = None) -> tuple[tuple, dict]:
        super().reset(seed=seed, options=options)
        self.cell = self.start
        return self._seen(), {}

    def step(self, action: int) -> tuple[tuple, float, bool, bool, dict]:
        beside = self._beside(action)
        self.cell = self.cell if self.walls[beside] else beside
        there = self.cell == self.goal
        return self._seen(), 10.0 if there else -0.1, there, False, {}

    def _beside(self, action: int) -> tuple[int, int]:
        return self.cell[0] + STEPS[action][0], self.cell[1] + STEPS[action][1]

    def _seen(self) -> tuple[tuple, tuple]:
        return self.cell, tuple(int(self.walls[self._beside(action)]) for action in range(len(STEPS)))
