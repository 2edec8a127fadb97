"""Q-learning on the errands of a maze, with advice in its ε branch and without: the cells of C3.16.

Thesis: §3.7.2.2 and Alg. 2: episodes of at most 200 steps, so that a goal far away is seldom met by chance.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.advisor import exploration_rows
from lifelore.action.advice.goal_model import GoalModel
from lifelore.core.learning.curve import Curve
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import QLearner, uniform_rows
from lifelore.core.mdp import Tables
from lifelore.core.streams import stream
from lifelore.experiments.chapter3.advice_grid import Errand, Maze, errands_of, maze_of, purposes_of
from lifelore.experiments.engine.curve_blocks import block_means

HANDFUL = 10
STARTS = ("one", "any")
"""Where a task's episodes start: all in one cell, drawn once for the task; or each anywhere."""
LEARNING = {
    "tasks": 5,
    "episodes": 5000,
    "max_episode_steps": 200,
    "learning_rate": 0.5,
    "last": 500,
}


def errand_tables(maze: Maze, found: Errand, number: int, starts: str) -> Tables:
    """The tables of errand `number` as the learner meets it."""
    if starts == "any":
        return found.tables
    start = stream(*maze.names, "start", number).choice(found.tables.starts, 1)
    return found.tables._replace(starts=start.astype(np.int32))


def learn_errand(
    settings: Mapping,
    maze: Maze,
    tables: Tables,
    number: int,
    schedule: Sequence[float],
    advice: NDArray[np.float64] | None = None,
    episodes: int | None = None,
) -> tuple[QLearner, Curve]:
    """One task learnt; `advice` (n_states, 4) is what its ε branch follows, uniform by default."""
    first, decay, floor = schedule
    learning = QLearning(
        episodes or settings["episodes"],
        settings["max_episode_steps"],
        settings["learning_rate"],
        first,
        decay,
        floor,
    )
    world, own = (stream(*maze.names, "learner", number, of) for of in ("world", "own"))
    rows = uniform_rows(tables, advice)
    return learning.learn(tables, maze.world.discount, world=world, own=own, rows=rows)


def learnt(settings: Mapping, reached: NDArray[np.bool_]) -> dict:
    """A task's numbers: the episode (from 1) that found the goal, the cap if none did; the reward at the end."""
    found = np.flatnonzero(reached)
    return {
        "first": int(found[0]) + 1 if found.size else settings["episodes"],
        "ever": bool(found.size),
        "in_ten": bool(found.size and found[0] < HANDFUL),
        "final": float(1000 * reached[-settings["last"] :].mean()),
    }


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One maze: every way of starting and every schedule, without advice and with each kind of experts'."""
    maze = maze_of(settings, cell, seed)
    advice: dict[str | None, NDArray | None] = {None: None}
    for experts in settings["experts"]:
        pooled = GoalModel.pooled(purposes_of(settings, maze, experts))
        advice[experts] = exploration_rows(pooled, settings["kappa"])
    learners = [
        {"starts": starts, "schedule": schedule, "experts": experts}
        | _learners(settings, maze, starts, schedule, rows)
        for starts in settings["starts"]
        for schedule in settings["schedules"]
        for experts, rows in advice.items()
    ]
    return {**cell, "learners": learners}


def _learners(settings: Mapping, maze: Maze, starts: str, schedule: Sequence[float], advice) -> dict:
    """All tasks of a maze learnt one way: their numbers, and their mean reward in blocks of episodes."""
    tasks, curves = [], []
    for number, found in enumerate(errands_of(maze, settings["tasks"])):
        tables = errand_tables(maze, found, number, starts)
        reached = learn_errand(settings, maze, tables, number, schedule, advice)[1].reached
        tasks.append(learnt(settings, reached))
        curves.append(1000 * reached.astype(float))
    return {"tasks": tasks, "curve": block_means(np.mean(curves, axis=0))}
