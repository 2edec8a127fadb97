"""Cells of C3.7: learners in new factories, with priors over features and over states, and without a prior.

Every prior counts the exact optimal policies of the same training factories, in all states alike.
Thesis: §3.4.4, §3.4.5, Figure 3.11.
"""

from collections.abc import Mapping
from functools import cache

import numpy as np

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.core.learning.q_learning import Rows
from lifelore.domains.factory.contexts import PHI
from lifelore.experiments.chapter3.factory.modified_tasks import (
    N_ACTIONS,
    Problem,
    contexts_of,
    learn_problem,
    problem_of,
)
from lifelore.experiments.chapter3.learning.schedules import schedule_of
from lifelore.experiments.engine.grid import READ_WITHOUT_PRIOR, Grid, run_grid

PLAIN, STATE = "uniform", "state"
METHODS = (PLAIN, STATE, *PHI)
KEYS = ("encoding", "schedule", "ties", "alpha0", "max_steps", "policies")
"""The choices left open that make a cell of the grid; only the prior over states reads ``encoding``."""

Priors = dict[tuple[str, int], ActionPrior]


def grid_of(settings: Mapping) -> Grid:
    """The grid: schedules of ε × ties, and every other choice one at a time."""
    singly = {"encoding": "encodings", "alpha0": "alpha0", "max_steps": "max_steps", "policies": "policies"}
    reads = {PLAIN: READ_WITHOUT_PRIOR, **dict.fromkeys(PHI, KEYS[1:])}
    return Grid.crossed(settings, KEYS, {"schedule": "schedules", "ties": "ties"}, singly, reads)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every method in every cell of the grid."""
    own = (seed, "C3.7", cell["run"])
    counted, grid = _priors(settings, own), grid_of(settings)
    testing = [problem_of(settings, (*own, "testing", i)) for i in range(settings["test_tasks"])]

    @cache
    def prior_of(name: str, policies: int, alpha0: float) -> ActionPrior:
        return ActionPrior.from_fixed_point_counts(*counted[name, policies].fixed_point_counts(), alpha0)

    def numbers(method: str, choice: Mapping) -> dict:
        name = f"{STATE} {choice['encoding']}" if method == STATE else method

        def rows_for(problem: Problem) -> Rows | None:
            if method == PLAIN:
                return None
            prior = prior_of(name, choice["policies"], choice["alpha0"])
            return prior_rows(problem.tables, contexts_of(problem, name), prior.probs, choice["ties"])

        schedule = schedule_of({**settings, "max_steps": choice["max_steps"]}, choice["schedule"])
        rewards = np.array([learn_problem(p, rows_for(p), schedule)[0].rewards for p in testing])
        found = {"early": float(rewards[:, : settings["early"]].mean()), "all": float(rewards.mean())}
        if grid.is_default_but_for_schedule(choice):
            found["mean"] = np.round(rewards.mean(axis=0), 2).tolist()
        return found

    found = list(run_grid(grid, "method", PLAIN, METHODS[1:], numbers))
    return {**cell, "optimal": float(np.mean([p.optimal for p in testing])), "found": found}


def _priors(settings: Mapping, own: tuple) -> Priors:
    """Priors by what they are conditioned on and number of policies, with α⁰ of 1."""
    names = [*PHI, *(f"{STATE} {encoding}" for encoding in settings["encodings"])]
    counting = {name: ActionPrior(N_ACTIONS, 1.0) for name in names}
    found = {}
    for i in range(max(settings["policies"])):
        problem = problem_of(settings, (*own, "training", i))
        for name, prior in counting.items():
            prior.update(contexts_of(problem, name), problem.best)
            if i + 1 in settings["policies"]:
                found[name, i + 1] = ActionPrior.merged([prior])
    return found
