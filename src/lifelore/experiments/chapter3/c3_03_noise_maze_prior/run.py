"""Learners in noise mazes, every task in a maze of its own, with priors on percepts or on places.

A run is some tasks on the lattice and some in noise mazes, whose policies make the priors, and test tasks in
other noise mazes. A place is its row and column, so that the lattice's counts can be read in a maze of the same
size: where the lattice had no free cell a prior on places knows nothing. Whatever is compared within a run meets
the same mazes, goals, starts and random numbers of its own. Thesis: §3.4.1, Figures 3.4 and 3.5, Alg. 2 and 4.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import FORMS, ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learning import Rows
from lifelore.core.planning.planning import best_actions, mean_start_value, optimal_q
from lifelore.core.streams import stream
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.grids.lattice import lattice
from lifelore.domains.grids.noise_maze import noise_maze
from lifelore.experiments.chapter3.lattice_learning import (
    ESCAPE,
    Problem,
    learn_task,
    schedule_of,
    start_values,
    summary,
)
from lifelore.experiments.engine.curve_blocks import block_means
from lifelore.experiments.engine.learning_settings import (
    check_among,
    check_counts,
    check_default,
    check_learning,
    check_windows,
)
from lifelore.experiments.engine.open_choices import default_of, how_key, is_default_but_for_schedule, plain_how

PLACE, PERCEPT = "place", "percept"
METHODS = {
    "qsap": (PLACE, "lattice"),
    "qpap": (PERCEPT, "noise"),
    "qsap_noise": (PLACE, "noise"),
    "qpap_lattice": (PERCEPT, "lattice"),
}
"""What a prior is conditioned on and where it was trained: the thesis's two, then each trained like the other."""
COMPARED = ("qsap", "qpap")
PLAIN = "q_learning"
READ_ALPHA0 = ("proportion", "dirichlet", "tempered")
"""Forms that α⁰ enters; the others are measured once, with α⁰ None."""
KEYS = ("schedule", "ties", "form", "alpha0", "max_steps", "training_tasks")
"""The choices left open that make a cell of the grid."""


class Met(NamedTuple):
    """A task as learners meet it, and the codes that priors may be conditioned on there, (n_states,) each."""

    problem: Problem
    contexts: dict[str, NDArray[np.int64]]


class Run(NamedTuple):
    """Training tasks by where they lie, and test tasks, all of these in noise mazes."""

    training: dict[str, list[Met]]
    testing: list[Met]


def run_of(settings: Mapping, seed: int, number: int) -> Run:
    """Run `number`; more training or test tasks leave the first ones as they are."""
    most = max(settings["training_tasks"])
    own = (seed, "C3.3", number)
    grid = lattice(settings["size"], settings["discount"])
    goals = stream(*own, "lattice").permutation(grid.n_states)[:most]
    on_lattice = [_met(grid, int(goal), (*own, "lattice", i)) for i, goal in enumerate(goals)]
    in_mazes = [_in_a_maze(settings, (*own, "training", i)) for i in range(most)]
    testing = [_in_a_maze(settings, (*own, "testing", i)) for i in range(settings["test_tasks"])]
    return Run({"lattice": on_lattice, "noise": in_mazes}, testing)


def _in_a_maze(settings: Mapping, names: tuple) -> Met:
    random = stream(*names, "maze")
    density = float(random.uniform(*settings["density"]))
    world = noise_maze(random, settings["size"], density, discount=settings["discount"])
    return _met(world, int(random.integers(world.n_states)), names)


def _met(world: GridWorld, goal: int, names: tuple) -> Met:
    tables = world.task(goal).tables()
    q = optimal_q(tables, world.discount)
    best = best_actions(q)
    best[goal] = False  # every action ties at the goal: nothing was chosen there
    place = world.cells.astype(np.int64) @ np.array([world.shape[1], 1])
    contexts = {PLACE: place, PERCEPT: world.percepts}
    return Met(Problem(goal, tables, names, q.max(axis=1), best), contexts)


def exact_prior(tasks: Sequence[Met], kind: str, alpha0: float) -> ActionPrior:
    """The prior on places or percepts from exact policies, tied actions counted (Eq. 3.1, 3.5, 3.7)."""
    prior = ActionPrior(4, alpha0)
    for task in tasks:
        prior.update(task.contexts[kind], task.problem.best)
    return prior


def rows_of(task: Met, prior: ActionPrior, kind: str, form: str, ties: str) -> Rows:
    """Rows of ε-QSAP or ε-QPAP; ``dirichlet`` draws θ once for the task, as the algorithms require."""
    random = stream(*task.problem.stream, "dirichlet")

    def probs_of(codes):
        return prior.probs(codes, form, generator=random, escape=ESCAPE)

    return prior_rows(task.problem.tables, task.contexts[kind], probs_of, ties)


def hows(settings: Mapping) -> list[dict]:
    """The grid: form × α⁰ × ties under every schedule, and each other cap and number of training tasks.

    α⁰ is crossed only where the form reads it; caps and numbers one at a time from the default, under every
    schedule.
    """
    default = default_of(settings, KEYS)
    ways = [
        {"ties": ties, "form": form, "alpha0": alpha0}
        for form in settings["forms"]
        for alpha0 in (settings["alpha0"] if form in READ_ALPHA0 else [None])
        for ties in settings["ties"]
    ]
    sizes = [{key: n} for key in ("max_steps", "training_tasks") for n in settings[key] if n != default[key]]
    return [{**default, "schedule": s, **way} for s, way in product(settings["schedules"], ways + sizes)]


def trained_alike(settings: Mapping) -> list[dict]:
    """Where the priors are also trained the other way round: the default under every schedule."""
    return [{**default_of(settings, KEYS), "schedule": schedule} for schedule in settings["schedules"]]


def cells(settings: Mapping) -> list[dict]:
    """A run each."""
    return [{"run": number} for number in range(settings["runs"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every method under every cell of the grid."""
    run = run_of(settings, seed, cell["run"])
    optimal = [mean_start_value(met.problem.tables, met.problem.values) for met in run.testing]
    return {**cell, "optimal": float(np.mean(optimal)), "found": list(_all_found(settings, run))}


def _all_found(settings: Mapping, run: Run) -> Iterator[dict]:
    """Numbers of Q-learning once for each schedule and cap, then of each method for each cell."""
    best = np.mean([start_values(met.problem, settings["episodes"]) for met in run.testing], axis=0)

    @cache
    def prior_of(kind: str, where: str, n_tasks: int, alpha0: float) -> ActionPrior:
        return exact_prior(run.training[where][:n_tasks], kind, alpha0)

    def numbers(how: Mapping, rows_for) -> dict:
        schedule = schedule_of({**settings, "max_steps": how["max_steps"]}, how["schedule"])
        returns = np.mean([learn_task(m.problem, rows_for(m), schedule)[0] for m in run.testing], axis=0)
        kept = summary(settings, returns, best)
        return (
            {**kept, "curve": block_means(returns)} if is_default_but_for_schedule(how, settings, KEYS) else kept
        )

    plain = {how_key(how, KEYS): how for how in (plain_how(h, KEYS) for h in hows(settings))}
    for how in plain.values():
        yield {"method": PLAIN, **how, **numbers(how, lambda met: None)}
    wanted = [(how, COMPARED) for how in hows(settings)]
    wanted += [(how, tuple(m for m in METHODS if m not in COMPARED)) for how in trained_alike(settings)]
    for how, methods in wanted:
        for method in methods:
            kind, where = METHODS[method]
            prior = prior_of(kind, where, how["training_tasks"], how["alpha0"] or 1.0)
            found = numbers(how, lambda met, p=prior, k=kind, h=how: rows_of(met, p, k, h["form"], h["ties"]))
            yield {"method": method, **how, **found}


def check(settings: Mapping) -> None:
    check_counts(settings, ("runs", "training_tasks", "test_tasks", "episodes", "max_steps", "window", "last"))
    check_windows(settings, ("window", "last"))
    check_learning(settings)
    check_among(settings, "forms", FORMS)
    among = {"ties": "ties", "schedule": "schedules", "alpha0": "alpha0", "form": "forms"}
    check_default(settings, {**among, "max_steps": "max_steps", "training_tasks": "training_tasks"})
    n_states = lattice(settings["size"], settings["discount"]).n_states
    if max(settings["training_tasks"]) > n_states:
        raise InputError(f"training_tasks must be at most the lattice's {n_states} cells that can be goals")
    density = settings["density"]
    if np.shape(density) != (2,) or not 0 <= density[0] <= density[1] < 1:
        raise InputError(f"density must be two shares of obstacles, rising, in [0, 1), got {density}")
