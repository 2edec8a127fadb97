"""DoorKey of MiniGrid, 5 × 5, with a hidden preference among three goals: one before the door, two behind it."""

from typing import Any

import gymnasium

from reproduction.chapter5.c5_10_one_life.worlds.family import Family
from reproduction.chapter5.c5_10_one_life.worlds.grid_preference import (
    Cell,
    features,
    free_cells,
    preferring,
    state,
)

TYPES = ("before the door", "behind, north", "behind, south")
MAX_STEPS = 60


def make(wanted: str, seed: int) -> gymnasium.Env:
    """The layout of a life, under a preference."""
    name = "minigrid:MiniGrid-DoorKey-5x5-v0"
    env = gymnasium.make(name, max_steps=MAX_STEPS, disable_env_checker=True)
    return preferring(env, places, seed, wanted)


def places(base: Any) -> tuple[dict[str, Cell], list[Cell]] | None:
    """Goals at both ends of the narrow room behind the door, and in a corner before it; the rest of it starts."""
    before, behind = free_cells(base, (0, 0), (3, 5)), (3, 1)
    corners = [cell for cell in before if cell[1] in (1, 3)]
    door_in_the_middle = getattr(base.grid.get(2, 2), "type", "") == "door"
    if not (door_in_the_middle and corners and len(before) > 1):
        return None
    goals: dict[str, Cell] = dict(zip(TYPES, (corners[0], behind, (3, 3)), strict=True))
    return goals, [cell for cell in before if cell != corners[0]]


DOOR_KEY = Family(TYPES, make, state, features, max_steps=MAX_STEPS, learner="model")
