"""The cells of C3.5 and C3.6: a sequence of factory tasks, each learnt with the prior of all before it.

Measuring and drawing live elsewhere, so that they can change without a new run. Thesis: §3.4.3, Figures 3.8, 3.9.
"""

from collections.abc import Mapping

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.planning.planning import learnt_best_actions
from lifelore.domains.factory.contexts import state_contexts
from lifelore.experiments.chapter3.factory_learning import (
    N_ACTIONS,
    Problem,
    exact_prior,
    learn_task,
    learnt_rows,
    problem_of,
    solved,
    tasks_of,
    with_pseudo_count,
)
from lifelore.experiments.chapter3.lattice_learning import schedule_of

SOURCES = ("exact", "own")
"""Whose policies are counted: exact optimal ones, or those that the learner has ended with itself."""


def cells(settings: Mapping) -> list[dict]:
    """The sequence of each run for each number of components; the grid for the first of them."""
    series = [
        {"kind": "series", "components": k, "run": run}
        for k in settings["components"]
        for run in range(settings["runs"])
    ]
    return series + [{"kind": "grid", "run": run} for run in range(settings["runs"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: the sequence at the default, or its last task with every choice left open."""
    found = _series(settings, cell, seed) if cell["kind"] == "series" else _grid(settings, cell, seed)
    return {**cell, **found}


def _series(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Mean reward of an episode in each task, (prior_tasks + 1,) a method; the n-th has n tasks behind it."""
    default, k, run = settings["default"], cell["components"], cell["run"]
    schedule = schedule_of(settings, default["schedule"])
    tasks = tasks_of(settings, seed, k, run, settings["prior_tasks"] + 1)
    priors = {
        (source, encoding): ActionPrior(N_ACTIONS, default["alpha0"])
        for source in SOURCES
        for encoding in settings["encodings"]
    }
    rewards: dict[str, list[float]] = {"uniform": [], **{" ".join(key): [] for key in priors}}
    optimal, seen = [], []
    for n, components in enumerate(tasks):
        problem = problem_of(settings, components, (seed, "factory", k, run, n))
        rewards["uniform"].append(float(learn_task(problem, None, schedule)[0].rewards.mean()))
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
    """The last task of the sequence, with priors of few and of all tasks before it, used in every way."""
    k, run, last = settings["components"][0], cell["run"], settings["prior_tasks"]
    tasks = tasks_of(settings, seed, k, run, last + 1)
    problem = problem_of(settings, tasks[last], (seed, "factory", k, run, last))
    priors = {
        (encoding, n): exact_prior([solved(t, settings["discount"]) for t in tasks[:n]], encoding, 1.0)
        for encoding in settings["encodings"]
        for n in settings["grid_tasks"]
    }
    uniform = []
    for epsilon in settings["schedules"]:
        curve, _ = learn_task(problem, None, schedule_of(settings, epsilon))
        uniform.append({"schedule": epsilon, "reward": float(curve.rewards.mean())})
    methods = []
    for how in uses(settings):
        of_encoding = {n: priors[how["encoding"], n] for n in settings["grid_tasks"]}
        methods.append({**how, "rewards": _rewards(settings, problem, of_encoding, how)})
    return {"uniform": uniform, "methods": methods, "optimal": problem.solved.optimal_reward}


def uses(settings: Mapping) -> list[dict]:
    """The ways to make and use a prior: encoding × α⁰ × ties × schedule of ε."""
    return [
        {"encoding": encoding, "alpha0": alpha0, "ties": ties, "schedule": schedule}
        for encoding in settings["encodings"]
        for alpha0 in settings["alpha0"]
        for ties in settings["ties"]
        for schedule in settings["schedules"]
    ]


def _rewards(settings: Mapping, problem: Problem, priors: Mapping[int, ActionPrior], how: Mapping) -> list[float]:
    """Mean reward of an episode with the prior of each number of tasks, in their order."""
    schedule, found = schedule_of(settings, how["schedule"]), []
    for prior in priors.values():
        rows = learnt_rows(problem, with_pseudo_count(prior, how["alpha0"]), how["encoding"], how["ties"])
        found.append(float(learn_task(problem, rows, schedule)[0].rewards.mean()))
    return found
