"""Cells of C3.5 and C3.6: a sequence of factory tasks, each learnt with the prior of all before it.

Thesis: §3.4.3, Figures 3.8 and 3.9.
"""

from collections.abc import Mapping
from functools import cache

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.planning.planning import learnt_best_actions
from lifelore.domains.factory.contexts import state_contexts
from lifelore.experiments.chapter3.factory.learning import (
    LEARNT,
    N_ACTIONS,
    PLAIN,
    exact_prior,
    grid_of,
    learn_task,
    learnt_rows,
    problem_of,
    solved,
    tasks_of,
    with_pseudo_count,
)
from lifelore.experiments.chapter3.learning.schedules import schedule_of
from lifelore.experiments.engine.grid import run_grid

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
    priors = {
        (source, encoding): ActionPrior(N_ACTIONS, default["alpha0"])
        for source in SOURCES
        for encoding in settings["encodings"]
    }
    rewards: dict[str, list[float]] = {PLAIN: [], **{" ".join(key): [] for key in priors}}
    optimal, seen = [], []
    for n, components in enumerate(tasks):
        problem = problem_of(settings, components, (seed, "factory", k, run, n))
        rewards[PLAIN].append(float(learn_task(problem, None, schedule)[0].rewards.mean()))
        optimal.append(problem.solved.optimal_reward)
        seen.append(components in tasks[:n])
        for (source, encoding), prior in priors.items():
            rows = learnt_rows(problem, prior, encoding, default["ties"])
            curve, learner = learn_task(problem, rows, schedule)
            rewards[f"{source} {encoding}"].append(float(curve.rewards.mean()))
            best = problem.solved.best if source == "exact" else learnt_best_actions(learner.q)
            prior.update(state_contexts(problem.solved.task, encoding), best)
    return {"rewards": rewards, "optimal": optimal, "seen": seen, "met": len(set(tasks[:-1]))}


def _grid(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean reward of an episode in the sequence's last task, with priors of few and of all tasks before it."""
    k, run, last = settings["components"][0], cell["run"], settings["prior_tasks"]
    tasks = tasks_of(settings, seed, k, run, last + 1)
    problem = problem_of(settings, tasks[last], (seed, "factory", k, run, last))

    @cache
    def prior_of(encoding: str, n: int) -> ActionPrior:
        return exact_prior([solved(t, settings["discount"]) for t in tasks[:n]], encoding, 1.0)

    def numbers(method: str, choice: Mapping) -> dict:
        schedule = schedule_of(settings, choice["schedule"])
        if method == PLAIN:
            return {"rewards": [float(learn_task(problem, None, schedule)[0].rewards.mean())] * 2}
        found = []
        for n in settings["grid_tasks"]:
            prior = with_pseudo_count(prior_of(choice["encoding"], n), choice["alpha0"])
            rows = learnt_rows(problem, prior, choice["encoding"], choice["ties"])
            found.append(float(learn_task(problem, rows, schedule)[0].rewards.mean()))
        return {"rewards": found}

    found = list(run_grid(grid_of(settings), "prior", PLAIN, (LEARNT,), numbers))
    return {"found": found, "optimal": problem.solved.optimal_reward}


def check(settings: Mapping) -> None:
    """Refuse late tasks that overlap the first ones, and numbers of tasks that do not rise."""
    if 2 * settings["late"] > settings["prior_tasks"]:
        raise InputError(
            f"late must be at most half of prior_tasks ({settings['prior_tasks']}), got {settings['late']}"
        )
    few, many = settings["grid_tasks"]
    if few >= many:
        raise InputError(f"grid_tasks must be two numbers, rising, got {settings['grid_tasks']}")
