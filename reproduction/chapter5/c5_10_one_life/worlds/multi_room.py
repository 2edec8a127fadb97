"""MultiRoom of MiniGrid with a hidden preference among three goals: one in the first room, two in the last."""

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

TYPES = ("first room", "last room, near", "last room, far")
MAX_STEPS, SIDE, LARGEST = 60, 14, 5
"""Most steps; side of the map that holds both rooms; largest side of a room with its walls."""


def make(wanted: str, seed: int) -> gymnasium.Env:
    """The layout of a life, under a preference."""
    env = gymnasium.make(
        "minigrid:MiniGrid-MultiRoom-N2-S4-v0",
        maxRoomSize=LARGEST,
        width=SIDE,
        height=SIDE,
        max_steps=MAX_STEPS,
        disable_env_checker=True,
    )
    return preferring(env, places, seed, wanted)


def places(base: Any) -> tuple[dict[str, Cell], list[Cell]] | None:
    """Goals as far from the door as a room allows, and a nearer one in the last room; the first room starts."""
    first, last = base.rooms
    door = last.entryDoorPos
    before, behind = free_cells(base, first.top, first.size), free_cells(base, last.top, last.size)
    behind.append((int(base.goal_pos[0]), int(base.goal_pos[1])))
    # Goals must not stand in the way: none beside the door, two in the last room not in one row or column.
    here = _farthest(before, door)
    far = _farthest(behind, door)
    near = [cell for cell in behind if cell[0] != far[0] and cell[1] != far[1] and _apart(cell, door) > 1]
    if _apart(here, door) < 3 or not near:
        return None
    goals: dict[str, Cell] = dict(zip(TYPES, (here, _farthest(near, door), far), strict=True))
    return goals, [cell for cell in before if cell != here]


def _apart(cell: Cell, door: Any) -> int:
    return abs(cell[0] - int(door[0])) + abs(cell[1] - int(door[1]))


def _farthest(cells: list[Cell], door: Any) -> Cell:
    return max(cells, key=lambda cell: (_apart(cell, door), cell))


MULTI_ROOM = Family(TYPES, make, state, features, max_steps=MAX_STEPS, learner="model")
