"""Cells of C3.2: every configuration of a prior on the lattice, and the prior accumulated task by task.

The thesis anneals the learning rate too, and does not print the cap of an episode: both are crossed with ε and
ties, at the default's form and α⁰.

Thesis: §3.4.1, Figure 3.3.
"""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learning import Schedule
from lifelore.core.planning.planning import learnt_best_actions, mean_start_value
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.grids.lattice import lattice
from reproduction.chapter3.learning import grid_tasks
from reproduction.chapter3.learning.grid_tasks import Problem, exact_prior, learn_task, rows_of
from reproduction.chapter3.learning.grid_tasks import prior_choices as configurations
from reproduction.chapter3.learning.schedules import schedule_of, with_learning_rate
from reproduction.engine.curve_blocks import block_means

KEYS = ("ties", "alpha0", "form")
"""Keys of a configuration."""
CROSSED_KEYS = ("schedule", "ties", "learning_rate", "max_steps")
"""Keys of a choice of learning, crossed at the default's form and α⁰; ties are None without a prior."""
PLAIN = dict.fromkeys(KEYS)
"""The configuration that is Q-learning."""


class Tasks(NamedTuple):
    """A lattice with the tasks whose policies make the prior, and those that are learnt."""

    world: GridWorld
    training: list[Problem]
    testing: list[Problem]


def cells(settings: Mapping) -> list[dict]:
    """A run under a schedule; and a run with its prior accumulated task by task."""
    runs = range(settings["runs"])
    grid = [{"kind": "grid", "schedule": s, "run": r} for r in runs for s in settings["schedules"]]
    return grid + [{"kind": kind, "run": r} for kind in ("online", "crossed") for r in runs]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every configuration under one schedule, the online series, or the other choices of learning."""
    run = run_of(settings, seed, cell["run"])
    if cell["kind"] == "crossed":
        choices = crossed_choices(settings) if cell["run"] < settings["crossed_runs"] else [annealed(settings)]
        found = _crossed(settings, run, choices)
    else:
        found = _grid(settings, run, cell["schedule"]) if cell["kind"] == "grid" else _online(settings, run)
    optimal = float(np.mean([mean_start_value(p.tables, p.values) for p in run.testing]))
    return {**cell, "optimal": optimal, **found}


def run_of(settings: Mapping, seed: int, number: int) -> Tasks:
    """Run `number`: goals are drawn without repeats, for training and for testing apart."""
    world = lattice(settings["size"], settings["discount"])
    most = max(settings["training_tasks"], *settings["online_tasks"])
    tasks = []
    for name, n_tasks in (("training", most), ("testing", settings["test_tasks"])):
        own = (seed, "C3.2", number, name)
        goals = stream(*own).permutation(world.n_states)[:n_tasks]
        tasks.append([grid_tasks.problem_of(world, int(goal), (*own, i)) for i, goal in enumerate(goals)])
    return Tasks(world, *tasks)


def _mean_returns(run: Tasks, prior: ActionPrior | None, how: Mapping, schedule: Schedule) -> np.ndarray:
    """Mean learning curve with a prior used in one way, or with none, (n_episodes,)."""

    def rows_for(problem: Problem):
        return None if prior is None else rows_of(problem, prior, how["form"], how["ties"])

    return grid_tasks.mean_returns(run.testing, rows_for, schedule)


def _grid(settings: Mapping, run: Tasks, epsilon: Sequence[float]) -> dict:
    """Every configuration, with the curves of the default's form and α⁰."""
    schedule, found = schedule_of(settings, epsilon), []
    best = np.mean([grid_tasks.start_values(p, settings["episodes"]) for p in run.testing], axis=0)
    for how in (PLAIN, *configurations(settings)):
        training = run.training[: settings["training_tasks"]]
        prior = None if how == PLAIN else exact_prior(training, how["alpha0"] or 1.0)
        returns = _mean_returns(run, prior, how, schedule)
        found.append({**how, **grid_tasks.summary(settings, returns, best)})
        if prior is None or all(how[key] == settings["default"][key] for key in ("alpha0", "form")):
            found[-1]["curve"] = block_means(returns)
    return {"methods": found}


def annealed(settings: Mapping) -> dict:
    """The default with α annealed as ε is: what the thesis prints of its learners."""
    default = settings["default"]
    kept = {"schedule": default["schedule"], "ties": default["ties"], "max_steps": settings["max_steps"]}
    return {**kept, "learning_rate": settings["learning_rates"][-1]}


def crossed_choices(settings: Mapping) -> list[dict]:
    """ε × ties × α × cap, without those that the grid has: the cap ``max_steps`` with a constant α."""
    values = (settings[key] for key in ("schedules", "ties", "learning_rates", "caps"))
    choices = [dict(zip(CROSSED_KEYS, one, strict=True)) for one in product(*values)]
    return [one for one in choices if one["max_steps"] != settings["max_steps"] or one["learning_rate"][1] != 1]


def without_ties(choice: Mapping) -> dict:
    """A choice of learning as Q-learning meets it."""
    return {**choice, "ties": None}


def _crossed(settings: Mapping, run: Tasks, choices: Sequence[Mapping]) -> dict:
    """Q-learning and the default's prior under choices of learning, each once."""
    default = settings["default"]
    prior = exact_prior(run.training[: settings["training_tasks"]], default["alpha0"])
    best = np.mean([grid_tasks.start_values(p, settings["episodes"]) for p in run.testing], axis=0)
    met = {str(one): one for choice in choices for one in (without_ties(choice), choice)}
    found = []
    for choice in met.values():
        schedule = schedule_of({**settings, "max_steps": choice["max_steps"]}, choice["schedule"])
        schedule = with_learning_rate(schedule, choice["learning_rate"])
        used = None if choice["ties"] is None else prior
        returns = _mean_returns(run, used, {**default, "ties": choice["ties"]}, schedule)
        found.append({**choice, **grid_tasks.summary(settings, returns, best)})
    return {"methods": found}


def _online(settings: Mapping, run: Tasks) -> dict:
    """First ten returns with the prior after so many tasks, from exact policies and from the learner's own."""
    default = settings["default"]
    schedule = schedule_of(settings, default["schedule"])
    own = online_priors(run, settings, schedule)
    found = {}
    for n_tasks in settings["online_tasks"]:
        exact = exact_prior(run.training[:n_tasks], default["alpha0"])
        for source, prior in (("exact", exact), ("learnt", own[n_tasks])):
            found[f"{source}_{n_tasks}"] = float(_mean_returns(run, prior, default, schedule)[:10].mean())
    plain = _mean_returns(run, None, default, schedule)
    return {"first_ten": found, "plain": float(plain[:10].mean()), "same": _same_bits(settings, run)}


def online_priors(run: Tasks, settings: Mapping, schedule: Schedule) -> list[ActionPrior]:
    """Priors after 0, 1, 2 … training tasks, each learnt with the prior so far, each policy the learner's own.

    A learnt policy is known in states where some action has been found to lead to the goal (Q > 0).
    """
    default = settings["default"]
    prior = ActionPrior(4, default["alpha0"])
    after = [ActionPrior.merged([prior])]
    for problem in run.training[: max(settings["online_tasks"])]:
        q = learn_task(problem, rows_of(problem, prior, default["form"], default["ties"]), schedule)[1].q
        prior.update(np.arange(len(q)), learnt_best_actions(q))
        after.append(ActionPrior.merged([prior]))
    return after


def _same_bits(settings: Mapping, run: Tasks) -> bool:
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
    rates = settings["learning_rates"]
    if rates[0][1] != 1 or settings["max_steps"] not in settings["caps"]:
        raise InputError(
            f"learning_rates must begin with a constant one and caps contain max_steps ({settings['max_steps']}), "
            f"got {rates} and {settings['caps']}"
        )
    n_states = lattice(settings["size"], settings["discount"]).n_states
    for key in ("test_tasks", "online_tasks"):
        if np.max(settings[key]) > n_states:
            raise InputError(f"{key} must be at most the {n_states} cells that can be goals, got {settings[key]}")
