"""Cells of C3.2: every configuration of a prior on the lattice, and the prior accumulated task by task.

Thesis: §3.4.1, Figure 3.3.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learning import Rows, Schedule
from lifelore.core.planning.planning import learnt_best_actions, mean_start_value
from lifelore.domains.grids.lattice import lattice
from lifelore.experiments.chapter3.lattice_learning import (
    Problem,
    Run,
    exact_prior,
    learn_task,
    mean_returns,
    rows_of,
    run_of,
    schedule_of,
    start_values,
    summary,
)
from lifelore.experiments.engine.curve_blocks import block_means

READ_ALPHA0 = ("proportion", "dirichlet", "tempered")
"""Forms that α⁰ enters; the others are measured once, with α⁰ None."""
KEYS = ("ties", "alpha0", "form")
"""Keys of a configuration."""
PLAIN = dict.fromkeys(KEYS)
"""The configuration that is Q-learning."""


def configurations(settings: Mapping) -> list[dict]:
    """Configurations of a prior: form × α⁰ × ties; α⁰ is None where the form does not read it."""
    return [
        {"ties": ties, "alpha0": alpha0, "form": form}
        for form in settings["forms"]
        for alpha0 in (settings["alpha0"] if form in READ_ALPHA0 else [None])
        for ties in settings["ties"]
    ]


def cells(settings: Mapping) -> list[dict]:
    """A run under a schedule; and a run with its prior accumulated task by task."""
    runs = range(settings["runs"])
    grid = [{"kind": "grid", "schedule": s, "run": r} for r in runs for s in settings["schedules"]]
    return grid + [{"kind": "online", "run": r} for r in runs]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every configuration under one schedule, or the online series."""
    run = run_of(settings, seed, cell["run"])
    found = _grid(settings, run, cell["schedule"]) if cell["kind"] == "grid" else _online(settings, run)
    optimal = float(np.mean([mean_start_value(p.tables, p.values) for p in run.testing]))
    return {**cell, "optimal": optimal, **found}


def _grid(settings: Mapping, run: Run, epsilon: Sequence[float]) -> dict:
    schedule = schedule_of(settings, epsilon)
    best = np.mean([start_values(p, settings["episodes"]) for p in run.testing], axis=0)
    plain = mean_returns(run.testing, lambda p: None, schedule)
    found = [{**PLAIN, **summary(settings, plain, best), "curve": block_means(plain)}]
    for how in configurations(settings):
        prior = exact_prior(run.training[: settings["training_tasks"]], how["alpha0"] or 1.0)
        returns = mean_returns(run.testing, _guided(prior, how), schedule)
        kept = {**how, **summary(settings, returns, best)}
        if _is_headline(settings, how):
            kept["curve"] = block_means(returns)
        found.append(kept)
    return {"methods": found}


def _guided(prior: ActionPrior, how: Mapping):
    """The rows that each problem gets from a prior used in one way."""

    def rows_for(problem: Problem) -> Rows:
        return rows_of(problem, prior, how["form"], how["ties"])

    return rows_for


def _is_headline(settings: Mapping, how: Mapping) -> bool:
    """Whether a configuration's curve is kept: the default's form and α⁰, ties in every way."""
    return all(how[key] == settings["default"][key] for key in ("alpha0", "form"))


def _online(settings: Mapping, run: Run) -> dict:
    """First ten returns with the prior after so many tasks, from exact policies and from the learner's own."""
    default = settings["default"]
    schedule = schedule_of(settings, default["schedule"])
    own = online_priors(run, settings, schedule)
    found = {}
    for n_tasks in settings["online_tasks"]:
        exact = exact_prior(run.training[:n_tasks], default["alpha0"])
        for source, prior in (("exact", exact), ("learnt", own[n_tasks])):
            returns = mean_returns(run.testing, _guided(prior, default), schedule)
            found[f"{source}_{n_tasks}"] = float(returns[:10].mean())
    plain = mean_returns(run.testing, lambda p: None, schedule)
    return {"first_ten": found, "plain": float(plain[:10].mean()), "same": _same_bits(settings, run)}


def online_priors(run: Run, settings: Mapping, schedule: Schedule) -> list[ActionPrior]:
    """Priors after 0, 1, 2 … training tasks, each learnt with the prior so far, each policy the learner's own.

    A learnt policy is known in states where some action has been found to lead to the goal (Q > 0).
    """
    default = settings["default"]
    prior = ActionPrior(4, default["alpha0"])
    after = [ActionPrior.merged([prior])]
    states = np.arange(run.world.n_states)
    for problem in run.training[: max(settings["online_tasks"])]:
        rows = rows_of(problem, prior, default["form"], default["ties"])
        q = learn_task(problem, rows, schedule)[1].q
        prior.update(states, learnt_best_actions(q))
        after.append(ActionPrior.merged([prior]))
    return after


def _same_bits(settings: Mapping, run: Run) -> bool:
    """Whether ε-QSAP with a prior that has seen nothing is Q-learning to the last bit, curve and values."""
    default = settings["default"]
    schedule = schedule_of(settings, default["schedule"])
    empty = ActionPrior(4, default["alpha0"])
    for problem in run.testing:
        returns, learner = learn_task(problem, None, schedule)
        others, other = learn_task(problem, rows_of(problem, empty, "proportion", default["ties"]), schedule)
        if returns.tobytes() != others.tobytes() or learner.q.tobytes() != other.q.tobytes():
            return False
    return True


def check(settings: Mapping) -> None:
    """Refuse series that lack the number of training tasks, and more tasks than the lattice has goals."""
    if not {0, settings["training_tasks"]} <= {*settings["online_tasks"]}:
        raise InputError(
            f"online_tasks must contain 0 and training_tasks ({settings['training_tasks']}), "
            f"got {settings['online_tasks']}"
        )
    n_states = lattice(settings["size"], settings["discount"]).n_states
    for key in ("test_tasks", "online_tasks"):
        if np.max(settings[key]) > n_states:
            raise InputError(f"{key} must be at most the {n_states} cells that can be goals, got {settings[key]}")
