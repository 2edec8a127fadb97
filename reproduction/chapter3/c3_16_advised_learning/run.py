"""C3.16: Q-learning on errands of a maze, with advice in its ε branch and without.

ε, its annealing and the start of a task's episodes are not printed: they are crossed with the maze's loops and the
kinds of experts. Tasks of one maze are not independent: intervals are over mazes. Other
buildings, and α⁰ in the advice, are run beside the default. Thesis: §3.7.2, Figure 3.22.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.advisor import exploration_rows
from lifelore.action.advice.goal_model import GoalModel
from reproduction.chapter3.advice import buildings
from reproduction.chapter3.advice.learning import learn_errands
from reproduction.chapter3.advice.mazes import Maze, goal_models_of, maze_cells, maze_of
from reproduction.engine.curve_blocks import block_means

HANDFUL = 10
"""Episodes within which a goal must be found."""


def cells(settings: Mapping) -> list[dict]:
    """The mazes of the grid, then those of the buildings beside it."""
    return maze_cells(settings) + buildings.building_cells(settings)


def check(settings: Mapping) -> None:
    """Refuse buildings that limits cannot describe."""
    buildings.check_buildings(settings["buildings"], settings)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: every start and schedule, without advice and with that of each kind of experts."""
    if "building" in cell:
        return _in_building(settings, cell, seed)
    maze = maze_of(settings, cell, seed)
    advice: dict[str | None, NDArray | None] = {None: None}
    for experts in settings["experts"]:
        pooled = GoalModel.pooled(goal_models_of(settings, maze, experts))
        advice[experts] = exploration_rows(pooled, settings["kappa"])
    learners = []
    for starts, schedule, experts in product(settings["starts"], settings["schedules"], advice):
        reached, numbers = _learnt(settings, maze, starts, schedule, advice[experts])
        numbers["curve"] = block_means(np.mean([1000 * of_task.astype(float) for of_task in reached], axis=0))
        learners.append({"starts": starts, "schedule": schedule, "experts": experts, **numbers})
    return {**cell, "learners": learners}


def _in_building(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze of a building at the default schedule, without advice (α⁰ None) and with it by α⁰."""
    maze, schedule = buildings.building_of(settings, cell, seed), settings["default"]["schedule"]
    pooled = GoalModel.pooled(goal_models_of(settings, maze, settings["default"]["experts"]))
    found = []
    for alpha0 in (None, *buildings.advised_alpha0(settings, cell)):
        rows = None
        if alpha0 is not None:
            rows = exploration_rows(replace(pooled, advised_alpha0=alpha0), settings["kappa"])
        found.append({"alpha0": alpha0, **_learnt(settings, maze, buildings.STARTS, schedule, rows)[1]})
    return {**cell, "beside": found}


def _learnt(
    settings: Mapping, maze: Maze, starts: str, schedule: Sequence[float], advice: NDArray | None
) -> tuple[list[NDArray[np.bool_]], dict[str, list]]:
    """Which episodes of each task reached its goal, and the numbers of `summary` by task."""
    reached = [curve.reached for _, curve in learn_errands(settings, maze, starts, schedule, advice)]
    tasks = [summary(settings, of_task) for of_task in reached]
    return reached, {key: [task[key] for task in tasks] for key in tasks[0]}


def summary(settings: Mapping, reached: NDArray[np.bool_]) -> dict:
    """A task's numbers: the episode (from 1) that found the goal, the cap if none did; the reward at the end."""
    found = np.flatnonzero(reached)
    return {
        "first": int(found[0]) + 1 if found.size else settings["episodes"],
        "ever": bool(found.size),
        "in_ten": bool(found.size and found[0] < HANDFUL),
        "final": float(1000 * reached[-settings["last"] :].mean()),
    }
