"""Cells of C3.9: rewards of the first and the last episode of each of thirty tasks, by the prior in use.

Nothing has converged by the last episode. The last tasks of each run are therefore also learnt on, to the end of
``long_episodes`` and with ε annealed to zero, with the priors that the agents have by then.
Thesis: §3.3.3, Alg. 6, §3.4.6, Figure 3.13.
"""

from collections.abc import Mapping

import numpy as np

from lifelore.core.errors import InputError
from reproduction.chapter3.factory import online_selection
from reproduction.chapter3.factory.modified_tasks import learn_problem, problem_of
from reproduction.chapter3.factory.online_selection import FULL, SELECTED, UNIFORM, Counting
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.curve_blocks import block_means
from reproduction.engine.grid import READ_WITHOUT_PRIOR, Grid

METHODS = (UNIFORM, FULL, SELECTED)
CHOICES = {"source": "sources", "schedule": "schedules", "ties": "ties", "max_steps": "max_steps"}
"""The choices left open that make a cell of the grid, each with its setting."""
KEYS = tuple(CHOICES)
SOURCES = {
    "learnt": Counting("learnt", "tried"),
    "learnt, promising": Counting("learnt", "visited"),
    "exact": Counting("exact", "all"),
}
"""The policies that count, and the states in which they count."""
ASKED = ("exact", "learnt")
"""The sources that the first reading asks about."""
OF_E4 = "learnt, promising"
"""The source of the second reading's headlines: a learnt policy counts in states that promise a reward (E4)."""


def grid_of(settings: Mapping) -> Grid:
    """All choices crossed: sources of policies × schedules of ε × ties × caps of an episode."""
    return Grid.crossed(settings, KEYS, CHOICES, reads={UNIFORM: READ_WITHOUT_PRIOR})


def first_grid_of(settings: Mapping) -> Grid:
    """The first reading's part of the grid: the default, then every other choice one at a time."""
    return Grid.crossed(settings, KEYS, {}, CHOICES, {UNIFORM: READ_WITHOUT_PRIOR})


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: rewards of first and last episodes, of every method in every cell of the grid."""
    grid = grid_of(settings)
    found = [{"method": method, **choice} for method in METHODS for choice in grid.cells_of(method)]
    agents = [_agent(settings, series) for series in found]
    for series in found:
        series |= {"first": [], "last": [], "n_features": []}
    losses: dict[int, list] = {place: [] for place, series in enumerate(found) if learns_on(settings, series)}
    optimal = []
    for i in range(settings["tasks"]):
        problem = problem_of(settings, (seed, "C3.9", cell["run"], i))
        optimal.append(problem.optimal)
        if i >= settings["tasks"] - settings["long_tasks"]:
            for place, of_series in losses.items():
                of_series.append(_loss_when_learnt_on(settings, problem, agents[place], found[place]["max_steps"]))
        for series, agent in zip(found, agents, strict=True):
            schedule = schedule_of({**settings, "max_steps": series["max_steps"]}, series["schedule"])
            curve = agent.learn(problem, schedule) if agent else learn_problem(problem, None, schedule)[0]
            series["first"].append(float(curve.rewards[0]))
            series["last"].append(float(curve.rewards[-1]))
            series["n_features"].append(len(agent.chosen) if agent else 0)
    for place, of_series in losses.items():
        loss = np.mean(of_series, axis=0)
        found[place] |= {"loss": block_means(loss), "loss_at_end": float(loss[-settings["long_last"] :].mean())}
    return {**cell, "optimal": optimal, "found": found}


def learns_on(settings: Mapping, series: Mapping) -> bool:
    """Whether a series is the default, whichever policies count; only these are learnt on."""
    default = settings["default"]
    return all(series[key] in (None, default[key]) for key in KEYS if key != "source")


def _loss_when_learnt_on(settings: Mapping, problem, agent, max_steps: int) -> np.ndarray:
    """Reward below the optimum of each of ``long_episodes``, (long_episodes,); the agent counts nothing."""
    rows = agent.rows(problem) if agent else None
    how = {**settings, "episodes": settings["long_episodes"], "max_steps": max_steps}
    curve, _ = learn_problem(problem, rows, schedule_of(how, settings["long_schedule"]))
    return problem.optimal - curve.rewards


def _agent(settings: Mapping, series: Mapping) -> online_selection.OnlineAgent | None:
    if series["method"] == UNIFORM:
        return None
    counting, selects = SOURCES[series["source"]], series["method"] == SELECTED
    return online_selection.OnlineAgent(selects, counting, settings["alpha0"], series["ties"])


def check(settings: Mapping) -> None:
    """Refuse settings without the sources that the claim asks about."""
    if not {*ASKED} <= {*settings["sources"]}:
        raise InputError(f"sources must hold {' and '.join(ASKED)}, got {settings['sources']}")
