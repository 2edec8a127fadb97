"""Cells of C3.9: rewards of the first and the last episode of each of thirty tasks, by the prior in use.

Thesis: §3.3.3, Alg. 6, §3.4.6, Figure 3.13.
"""

from collections.abc import Mapping

import numpy as np

from lifelore.core.errors import InputError
from lifelore.experiments.chapter3.factory.modified_tasks import Problem, learn_problem, problem_of
from lifelore.experiments.chapter3.factory.online_selection import (
    FULL,
    SELECTED,
    UNIFORM,
    Counting,
    OnlineAgent,
)
from lifelore.experiments.chapter3.learning.schedules import schedule_of
from lifelore.experiments.engine.grid import READ_WITHOUT_PRIOR, Grid

METHODS = (UNIFORM, FULL, SELECTED)
KEYS = ("source", "schedule", "ties", "max_steps")
"""The choices left open that make a cell of the grid."""
SOURCES = {
    "learnt": Counting("learnt", "tried"),
    "learnt, promising": Counting("learnt", "visited"),
    "exact": Counting("exact", "all"),
}
"""The policies that count, and the states in which they count."""
ASKED = ("exact", "learnt")
"""The sources that the claim asks about."""


def grid_of(settings: Mapping) -> Grid:
    """The default, then every other choice one at a time."""
    singly = {"source": "sources", "schedule": "schedules", "ties": "ties", "max_steps": "max_steps"}
    return Grid.crossed(settings, KEYS, {}, singly, {UNIFORM: READ_WITHOUT_PRIOR})


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: rewards of first and last episodes, of every method in every cell of the grid."""
    grid = grid_of(settings)
    learners = [_Series(settings, method, choice) for method in METHODS for choice in grid.cells_of(method)]
    optimal = []
    for i in range(settings["tasks"]):
        problem = problem_of(settings, (seed, "C3.9", cell["run"], i))
        optimal.append(problem.optimal)
        for learner in learners:
            learner.learn(problem)
    return {**cell, "optimal": optimal, "found": [learner.found() for learner in learners]}


class _Series:
    """A method that goes from task to task in a cell of the grid."""

    def __init__(self, settings: Mapping, method: str, choice: Mapping) -> None:
        self.labels = {"method": method, **choice}
        self.schedule = schedule_of({**settings, "max_steps": choice["max_steps"]}, choice["schedule"])
        self.agent = None
        if method != UNIFORM:
            counting = SOURCES[choice["source"]]
            self.agent = OnlineAgent(method == SELECTED, counting, settings["alpha0"], choice["ties"])
        self.rewards: list[np.ndarray] = []
        self.n_features: list[int] = []

    def learn(self, problem: Problem) -> None:
        agent = self.agent
        curve = agent.learn(problem, self.schedule) if agent else learn_problem(problem, None, self.schedule)[0]
        self.rewards.append(curve.rewards[[0, -1]])
        self.n_features.append(len(agent.chosen) if agent else 0)

    def found(self) -> dict:
        first, last = np.array(self.rewards).T
        return {**self.labels, "first": first.tolist(), "last": last.tolist(), "n_features": self.n_features}


def check(settings: Mapping) -> None:
    """Refuse settings without the sources that the claim asks about."""
    if not {*ASKED} <= {*settings["sources"]}:
        raise InputError(f"sources must hold {' and '.join(ASKED)}, got {settings['sources']}")
