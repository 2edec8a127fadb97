"""Cells of C3.5, and of C3.6: a sequence of factory tasks, each learnt with the prior of all before it.

There are only nine tasks of one component, so that at the end all have been met. Thesis: §3.4.3, Figure 3.8.
"""

from collections.abc import Mapping
from functools import cache
from itertools import product

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.planning.planning import learnt_best_actions
from reproduction.chapter3.factory import learning
from reproduction.chapter3.factory.learning import LEARNT, PLAIN, learn_task, problem_of, tasks_of
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.grid import run_grid

SOURCES = ("exact", "own")
"""The policies that are counted: exact optimal ones, or those that the learner ends with."""


def cells(settings: Mapping) -> list[dict]:
    """The sequence of each run for each number of components; the grid for the first of them."""
    runs = range(settings["runs"])
    series = [{"kind": "series", "components": k, "run": run} for k in settings["components"] for run in runs]
    return series + [{"kind": "grid", "run": run} for run in runs]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: the sequence at the default, or its last task with every choice left open."""
    found = _series(settings, cell, seed) if cell["kind"] == "series" else _grid(settings, cell, seed)
    return {**cell, **found}


def _series(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean reward of an episode in each task, (prior_tasks + 1,) a method; task n has n tasks before it."""
    default, k, run = settings["default"], cell["components"], cell["run"]
    schedule = schedule_of(settings, default["schedule"])
    tasks = tasks_of(settings, seed, k, run, settings["prior_tasks"] + 1)
    keys = product(SOURCES, settings["encodings"])
    priors = {key: ActionPrior(learning.N_ACTIONS, default["alpha0"]) for key in keys}
    rewards: dict[str, list[float]] = {PLAIN: [], **{" ".join(key): [] for key in priors}}
    optimal, seen = [], []
    for n, components in enumerate(tasks):
        problem = problem_of(settings, components, (seed, "factory", k, run, n))
        rewards[PLAIN].append(float(learn_task(problem, None, schedule)[0].rewards.mean()))
        optimal.append(problem.solved.optimal_reward)
        seen.append(components in tasks[:n])
        for (source, encoding), prior in priors.items():
            rows = learning.rows_of(problem, prior, encoding, default["ties"])
            curve, learner = learn_task(problem, rows, schedule)
            rewards[f"{source} {encoding}"].append(float(curve.rewards.mean()))
            best = problem.solved.best if source == "exact" else learnt_best_actions(learner.q)
            prior.update(learning.contexts_of(problem, encoding), best)
    return {"rewards": rewards, "optimal": optimal, "seen": seen, "met": len(set(tasks[:-1]))}


def _grid(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean reward of an episode in the sequence's last task, with priors of few and of all tasks before it."""
    k, run, last = settings["components"][0], cell["run"], settings["prior_tasks"]
    tasks = tasks_of(settings, seed, k, run, last + 1)
    problem = problem_of(settings, tasks[last], (seed, "factory", k, run, last))

    @cache
    def prior_of(encoding: str, n: int) -> ActionPrior:
        return learning.exact_prior([learning.solved(t, settings["discount"]) for t in tasks[:n]], encoding, 1.0)

    def numbers(method: str, choice: Mapping) -> dict:
        rewards = []
        for n in settings["grid_tasks"]:
            rows = None
            if method == LEARNT:
                prior = learning.with_pseudo_count(prior_of(choice["encoding"], n), choice["alpha0"])
                rows = learning.rows_of(problem, prior, choice["encoding"], choice["ties"])
            curve, _ = learn_task(problem, rows, schedule_of(settings, choice["schedule"]))
            rewards.append(float(curve.rewards.mean()))
        return {"rewards": rewards}

    found = list(run_grid(learning.grid_of(settings), "prior", PLAIN, (LEARNT,), numbers))
    return {"found": found, "optimal": problem.solved.optimal_reward}


def check(settings: Mapping) -> None:
    """Refuse late tasks that overlap the first ones, and numbers of tasks that do not rise."""
    n_tasks, (few, many) = settings["prior_tasks"], settings["grid_tasks"]
    if 2 * settings["late"] > n_tasks:
        raise InputError(f"late must be at most half of prior_tasks ({n_tasks}), got {settings['late']}")
    if few >= many:
        raise InputError(f"grid_tasks must be two numbers, rising, got {settings['grid_tasks']}")
