"""An assistive robot in a ward, and an explorer who is advised: Figures 1.1, 3.17 and 3.19 as ours draws them.

``python -m docs.pictures.buildings`` writes them to ``docs/pictures``. The floors are an
invented office and an advice maze; the way, the walk and the advice are computed, the people and notes are not.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from docs.pictures.figure_advice_system import draw_advice_system
from docs.pictures.figure_ward import draw_advised_walk, draw_ward
from lifelore.action.advice.goal_model import GoalModel
from lifelore.core.learning.known_world import GOAL, goal_distances
from lifelore.domains.buildings.building import building_from_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.figures.style import save_figure
from reproduction.chapter3.advice import mazes
from reproduction.engine.registry import claim_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FOLDER = Path("docs/pictures")
FLOOR = 4
"""Seed of the ward's floor, an office."""
MAZE, ERRAND = 1, 7
"""Of claim C3.18 at its default: the explorer is lost at once, and reaches its goal in some hundred steps."""


def plates() -> Iterator[tuple[str, "Figure"]]:
    """File name and figure of each."""
    yield "assistive_robot", draw_ward(ward())
    yield "advised_walk", draw_advised_walk(walk())
    yield "advice_system", draw_advice_system()


def ward() -> dict:
    """What Figure 1.1 shows: people and objects by hand, the robot's way a shortest one."""
    world = building_from_map(office_map(FLOOR, 26.0, 15.0))
    way = straight_way(world, _state(world, 13, 4), _state(world, 29, 46))
    people = {
        "patient": [(4, 3), (4, 20), (5, 39), (22, 17), (20, 31), (30, 47), (29, 17)],
        "nurse": [(13, 27), (9, 14), (19, 43)],
        "doctor": [(14, 48), (3, 52)],
    }
    objects = [(9, 4), (3, 13), (5, 27), (10, 34), (18, 4), (25, 17), (18, 48), (30, 33), (26, 44), (29, 8)]
    return {
        "shape": world.shape,
        "cells": world.cells,
        "neighbour": world.neighbour,
        "people": {kind: _snapped(world, places) for kind, places in people.items()},
        "objects": _snapped(world, objects),
        "way": world.cells[way],
        "places": [((8.5, 7.0), (4.0, 8.6)), ((21.0, 18.6), (21.0, 14.2)), ((48.0, 24.5), (46.8, 28.6))],
        "notes": [
            "what is on, and beside, what?",
            "what is sensible here,\nwhatever the task?",
            "whom do I serve now,\nand what suits them?",
        ],
    }


def walk() -> dict:
    """What Figure 3.17 shows: a walk of claim C3.18, of a goal-seeking bug in an advice maze."""
    settings = claim_of("C3.18").settings("full")
    maze = mazes.maze_of(settings, {"loops": settings["loops"][0], "maze": MAZE}, seed=0)
    models = mazes.goal_models_of(maze, **mazes.choices_of(settings)[0])
    found = mazes.errands_of(maze, settings["tasks"])[ERRAND]
    policies = mazes.policies_of(settings, maze, "bug")
    done = mazes.walks_of(settings, maze, policies, mazes.thesis_advisor(models))[ERRAND]
    shown = int(np.flatnonzero(done.advised)[0])
    world = maze.world
    return {
        "shape": world.shape, "cells": world.cells, "neighbour": world.neighbour,
        "path": world.cells[done.states],
        "p_normal": done.p_normal,
        "advised": done.advised,
        "theta": GoalModel.pooled(models).theta[done.states[shown]],
        "shown": shown,
        "goal": world.cells[found.goal],
    }  # fmt: skip


def straight_way(world: GridWorld, start: int, goal: int) -> list[int]:
    """A shortest way that turns only where it must."""
    place = np.zeros(world.n_states, np.int8)
    place[goal] = GOAL
    steps = goal_distances(world.neighbour, place)
    best = (world.neighbour >= 0) & (steps[world.neighbour] == steps[:, None] - 1)
    states, last = [start], -1
    while states[-1] != goal:
        ways = best[states[-1]]
        last = last if last >= 0 and ways[last] else int(np.argmax(ways))
        states.append(int(world.neighbour[states[-1], last]))
    return states


def _state(world: GridWorld, row: int, column: int) -> int:
    """The state nearest to a place of the plan."""
    return int(np.abs(world.cells - (row, column)).sum(axis=1).argmin())


def _snapped(world: GridWorld, places) -> np.ndarray:
    return world.cells[[_state(world, *place) for place in places]]


if __name__ == "__main__":
    for name, figure in plates():
        print(save_figure(figure, FOLDER / f"{name}.png"))
