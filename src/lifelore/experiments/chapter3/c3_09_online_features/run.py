"""The cells of C3.9: what the first and the last episode of each of thirty tasks earn, by the prior in use.

Thesis: §3.3.3, Alg. 6, §3.4.6, Figure 3.13.
"""

from collections.abc import Mapping

import numpy as np

from lifelore.action.priors.exploration import TIES
from lifelore.core.errors import InputError
from lifelore.experiments.chapter3.c3_07_feature_sets.run import check_components
from lifelore.experiments.chapter3.lattice_learning import schedule_of
from lifelore.experiments.chapter3.modified_factory_tasks import Problem, problem_of
from lifelore.experiments.chapter3.online_selection import (
    FULL,
    SELECTED,
    UNIFORM,
    Counting,
    OnlineAgent,
    defaults_and_others,
    learn_uniformly,
)
from lifelore.experiments.engine.learning_settings import check_among, check_counts, check_default, check_learning
from lifelore.experiments.engine.open_choices import default_of, how_key, plain_how

METHODS = (UNIFORM, FULL, SELECTED)
KEYS = ("source", "schedule", "ties", "max_steps")
"""The choices left open that make a cell of the grid."""
SOURCES = {
    "learnt": Counting("learnt", "tried"),
    "learnt, promising": Counting("learnt", "visited"),
    "exact": Counting("exact", "all"),
}
"""Whose policies count, and where."""


def hows(settings: Mapping) -> list[dict]:
    """The default, then every other choice one at a time."""
    lists = {"source": "sources", "schedule": "schedules"}
    choices = {key: settings[lists.get(key, key)] for key in KEYS}
    return defaults_and_others(default_of(settings, KEYS), choices)


def method_how(method: str, how: Mapping) -> dict:
    """A cell of the grid as one method meets it."""
    return plain_how(how, KEYS) if method == UNIFORM else {key: how[key] for key in KEYS}


def cells(settings: Mapping) -> list[dict]:
    """A run each."""
    return [{"run": number} for number in range(settings["runs"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: rewards of first and last episodes, a number a task, of every method in every cell of the grid."""
    met = {}
    for method in METHODS:
        for how in hows(settings):
            read = method_how(method, how)
            met.setdefault((method, how_key(read, KEYS)), _Series(settings, method, read))
    optimal = []
    for i in range(settings["tasks"]):
        problem = problem_of(settings, (seed, "C3.9", cell["run"], i))
        optimal.append(problem.optimal)
        for series in met.values():
            series.learn(problem)
    return {**cell, "optimal": optimal, "found": [series.found() for series in met.values()]}


class _Series:
    """One method going from task to task in one cell of the grid."""

    def __init__(self, settings: Mapping, method: str, how: dict) -> None:
        self.method, self.how = method, how
        self.schedule = schedule_of({**settings, "max_steps": how["max_steps"]}, how["schedule"])
        self.agent = None
        if method != UNIFORM:
            counting = SOURCES[how["source"]]
            self.agent = OnlineAgent(method == SELECTED, counting, settings["alpha0"], how["ties"])
        self.rewards: list[np.ndarray] = []
        self.n_features: list[int] = []

    def learn(self, problem: Problem) -> None:
        agent = self.agent
        curve = agent.learn(problem, self.schedule) if agent else learn_uniformly(problem, self.schedule)
        self.rewards.append(curve.rewards[[0, -1]])
        self.n_features.append(len(agent.chosen) if agent else 0)

    def found(self) -> dict:
        first, last = np.array(self.rewards).T
        of_task = {"first": first.tolist(), "last": last.tolist(), "n_features": self.n_features}
        return {"method": self.method, **self.how, **of_task}


ASKED = ("exact", "learnt")
"""Whose policies the claim is asked of."""


def check(settings: Mapping) -> None:
    check_counts(settings, ("runs", "episodes", "max_steps", "components"))
    check_counts(settings, ("tasks",), least=2)  # before the first task there is no prior
    check_learning(settings)
    check_among(settings, "sources", tuple(SOURCES))
    check_among(settings, "ties", TIES)
    check_default(settings, {"source": "sources", "schedule": "schedules", **{key: key for key in KEYS[2:]}})
    check_components(settings)
    if not {*ASKED} <= {*settings["sources"]}:
        raise InputError(f"sources must hold {' and '.join(ASKED)}, got {settings['sources']}")
    if settings["alpha0"] <= 0:
        raise InputError(f"alpha0 must be positive, got {settings['alpha0']}")
