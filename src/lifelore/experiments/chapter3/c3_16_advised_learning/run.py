"""C3.16: Q-learning on errands of a maze, with advice in its ε branch and without.

ε, its annealing and the start of a task's episodes are not printed: they are crossed with the maze's loops and the
kinds of experts. Tasks of one maze are not independent: intervals are over mazes. Thesis: §3.7.2, Figure 3.22.
"""

from collections.abc import Mapping
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.advisor import exploration_rows
from lifelore.action.advice.goal_model import GoalModel
from lifelore.experiments.chapter3.advice.learning import errand_tables, learn_errand
from lifelore.experiments.chapter3.advice.mazes import errands_of, goal_models_of, maze_of
from lifelore.experiments.chapter3.advice.mazes import maze_cells as cells
from lifelore.experiments.engine.curve_blocks import block_means

__all__ = ["cells", "run_cell"]
HANDFUL = 10
"""Episodes within which a goal must be found."""


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: every start and schedule, without advice and with that of each kind of experts."""
    maze = maze_of(settings, cell, seed)
    advice: dict[str | None, NDArray | None] = {None: None}
    for experts in settings["experts"]:
        pooled = GoalModel.pooled(goal_models_of(settings, maze, experts))
        advice[experts] = exploration_rows(pooled, settings["kappa"])
    learners = []
    for starts, schedule, experts in product(settings["starts"], settings["schedules"], advice):
        tasks, curves = [], []
        for number, errand in enumerate(errands_of(maze, settings["tasks"])):
            tables = errand_tables(maze, errand, number, starts)
            reached = learn_errand(settings, maze, tables, number, schedule, advice[experts])[1].reached
            tasks.append(summary(settings, reached))
            curves.append(1000 * reached.astype(float))
        about = {"starts": starts, "schedule": schedule, "experts": experts}
        numbers = {key: [task[key] for task in tasks] for key in tasks[0]}
        learners.append({**about, **numbers, "curve": block_means(np.mean(curves, axis=0))})
    return {**cell, "learners": learners}


def summary(settings: Mapping, reached: NDArray[np.bool_]) -> dict:
    """A task's numbers: the episode (from 1) that found the goal, the cap if none did; the reward at the end."""
    found = np.flatnonzero(reached)
    return {
        "first": int(found[0]) + 1 if found.size else settings["episodes"],
        "ever": bool(found.size),
        "in_ten": bool(found.size and found[0] < HANDFUL),
        "final": float(1000 * reached[-settings["last"] :].mean()),
    }
