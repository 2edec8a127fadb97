"""Cells of C3.7: learners in new factories, with priors over features and over states, and without a prior.

Every prior counts the exact optimal policies of the same training factories, in all states alike.
Thesis: §3.4.4, §3.4.5, Figure 3.11.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.domains.factory.contexts import PHI
from reproduction.chapter3.factory import modified_tasks
from reproduction.chapter3.factory.learning import with_pseudo_count
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.grid import READ_WITHOUT_PRIOR, Grid, run_grid

PLAIN, STATE = "uniform", "state"
METHODS = (PLAIN, STATE, *PHI)
KEYS = ("encoding", "schedule", "ties", "alpha0", "max_steps", "policies", "walls")
"""The choices left open that make a cell of the grid; only the prior over states reads ``encoding``."""


def grid_of(settings: Mapping) -> Grid:
    """The grid: numbers of inner walls × schedules of ε × ties, and every other choice one at a time.

    The first reading's grid is the part of it with the default number of walls.
    """
    crossed = {"walls": "walls", "schedule": "schedules", "ties": "ties"}
    singly = {"encoding": "encodings", "alpha0": "alpha0", "max_steps": "max_steps", "policies": "policies"}
    reads = {PLAIN: (*READ_WITHOUT_PRIOR, "walls"), **dict.fromkeys(PHI, KEYS[1:])}
    return Grid.crossed(settings, KEYS, crossed, singly, reads)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every method in every cell of the grid."""
    own, grid = (seed, "C3.7", cell["run"]), grid_of(settings)
    of_walls = {tuple(walls): _tasks(settings, own, walls, grid.default) for walls in settings["walls"]}

    def numbers(method: str, choice: Mapping) -> dict:
        name = f"{STATE} {choice['encoding']}" if method == STATE else method
        priors, testing = of_walls[tuple(choice["walls"])]
        prior = None
        if method != PLAIN:
            prior = with_pseudo_count(priors[name, choice["policies"]], choice["alpha0"])

        def rows_for(problem: modified_tasks.Problem):
            return None if prior is None else modified_tasks.rows_of(problem, name, prior.probs, choice["ties"])

        schedule = schedule_of({**settings, "max_steps": choice["max_steps"]}, choice["schedule"])
        rewards = modified_tasks.rewards_of(testing, rows_for, schedule)
        found = {"early": float(rewards[:, : settings["early"]].mean()), "all": float(rewards.mean())}
        if grid.is_default_but_for_schedule(choice):
            found["mean"] = np.round(rewards.mean(axis=0), 2).tolist()
        return found

    found = list(run_grid(grid, "method", PLAIN, METHODS[1:], numbers))
    optimal = [[p.optimal for p in of_walls[tuple(walls)][1]] for walls in settings["walls"]]
    at_default = settings["walls"].index(grid.default["walls"])
    return {**cell, "optimal": float(np.mean(optimal[at_default])), "optimal_of_walls": optimal, "found": found}


def _tasks(settings: Mapping, own: tuple, walls: Sequence[int], default: Mapping):
    """Priors and test tasks of layouts with so many inner walls; every code of states at the default alone."""
    encodings = settings["encodings"] if walls == default["walls"] else [default["encoding"]]
    conditions = [*PHI, *(f"{STATE} {encoding}" for encoding in encodings)]
    priors = modified_tasks.exact_priors(settings, (*own, "training"), conditions, walls)
    return priors, modified_tasks.problems_of(settings, (*own, "testing"), settings["test_tasks"], walls)
