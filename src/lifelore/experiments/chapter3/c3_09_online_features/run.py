"""Cells of C3.9: rewards of the first and the last episode of each of thirty tasks, by the prior in use.

Thesis: §3.3.3, Alg. 6, §3.4.6, Figure 3.13.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter3.factory import online_selection
from lifelore.experiments.chapter3.factory.modified_tasks import learn_problem, problem_of
from lifelore.experiments.chapter3.factory.online_selection import FULL, SELECTED, UNIFORM, Counting
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
    found = [{"method": method, **choice} for method in METHODS for choice in grid.cells_of(method)]
    agents = [_agent(settings, series) for series in found]
    for series in found:
        series |= {"first": [], "last": [], "n_features": []}
    optimal = []
    for i in range(settings["tasks"]):
        problem = problem_of(settings, (seed, "C3.9", cell["run"], i))
        optimal.append(problem.optimal)
        for series, agent in zip(found, agents, strict=True):
            schedule = schedule_of({**settings, "max_steps": series["max_steps"]}, series["schedule"])
            curve = agent.learn(problem, schedule) if agent else learn_problem(problem, None, schedule)[0]
            series["first"].append(float(curve.rewards[0]))
            series["last"].append(float(curve.rewards[-1]))
            series["n_features"].append(len(agent.chosen) if agent else 0)
    return {**cell, "optimal": optimal, "found": found}


def _agent(settings: Mapping, series: Mapping) -> online_selection.OnlineAgent | None:
    if series["method"] == UNIFORM:
        return None
    counting, selects = SOURCES[series["source"]], series["method"] == SELECTED
    return online_selection.OnlineAgent(selects, counting, settings["alpha0"], series["ties"])


def check(settings: Mapping) -> None:
    """Refuse settings without the sources that the claim asks about."""
    if not {*ASKED} <= {*settings["sources"]}:
        raise InputError(f"sources must hold {' and '.join(ASKED)}, got {settings['sources']}")
