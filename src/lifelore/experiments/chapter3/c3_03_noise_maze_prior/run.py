"""Cells of C3.3: learners in noise mazes, each task in its own maze, with priors on percepts or on places.

A run is some tasks on the lattice and some in noise mazes, whose policies make the priors, and test tasks in
other noise mazes. A place is its row and column, so that the lattice's counts can be read in a maze of the same
size; where the lattice had no free cell, a prior on places has no counts. All methods of a run meet the same
mazes, goals and starts, with the same random numbers. Thesis: §3.4.1, Figures 3.4 and 3.5, Alg. 2 and 4.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
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
from lifelore.experiments.engine.grid import READ_WITHOUT_PRIOR, Grid, run_grid

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


class Task(NamedTuple):
    """A task as learners meet it, and the codes that priors may be conditioned on there, (n_states,) each."""

    problem: Problem
    contexts: dict[str, NDArray[np.int64]]


class Run(NamedTuple):
    """Training tasks by where they lie, and test tasks, all of these in noise mazes."""

    training: dict[str, list[Task]]
    testing: list[Task]


def run_of(settings: Mapping, seed: int, number: int) -> Run:
    """Run `number`; more training or test tasks leave the first ones as they are."""
    most = max(settings["training_tasks"])
    own = (seed, "C3.3", number)
    grid = lattice(settings["size"], settings["discount"])
    goals = stream(*own, "lattice").permutation(grid.n_states)[:most]
    on_lattice = [_task(grid, int(goal), (*own, "lattice", i)) for i, goal in enumerate(goals)]
    in_mazes = [_in_a_maze(settings, (*own, "training", i)) for i in range(most)]
    testing = [_in_a_maze(settings, (*own, "testing", i)) for i in range(settings["test_tasks"])]
    return Run({"lattice": on_lattice, "noise": in_mazes}, testing)


def _in_a_maze(settings: Mapping, names: tuple) -> Task:
    random = stream(*names, "maze")
    density = float(random.uniform(*settings["density"]))
    world = noise_maze(random, settings["size"], density, discount=settings["discount"])
    return _task(world, int(random.integers(world.n_states)), names)


def _task(world: GridWorld, goal: int, names: tuple) -> Task:
    tables = world.task(goal).tables()
    q = optimal_q(tables, world.discount)
    best = best_actions(q)
    best[goal] = False  # every action ties at the goal: nothing was chosen there
    place = world.cells.astype(np.int64) @ np.array([world.shape[1], 1])
    contexts = {PLACE: place, PERCEPT: world.percepts}
    return Task(Problem(goal, tables, names, q.max(axis=1), best), contexts)


def exact_prior(tasks: Sequence[Task], kind: str, alpha0: float) -> ActionPrior:
    """The prior on places or percepts from exact policies, tied actions counted (Eq. 3.1, 3.5, 3.7)."""
    prior = ActionPrior(4, alpha0)
    for task in tasks:
        prior.update(task.contexts[kind], task.problem.best)
    return prior


def rows_of(task: Task, prior: ActionPrior, kind: str, form: str, ties: str) -> Rows:
    """Rows of ε-QSAP or ε-QPAP; ``dirichlet`` draws θ once for the task, as the algorithms require."""
    random = stream(*task.problem.stream, "dirichlet")

    def probs_of(codes):
        return prior.probs(codes, form, generator=random, escape=ESCAPE)

    return prior_rows(task.problem.tables, task.contexts[kind], probs_of, ties)


def grid_of(settings: Mapping) -> Grid:
    """The grid: form × α⁰ × ties under every schedule, and each other cap and number of training tasks.

    α⁰ is crossed only where the form reads it; caps and numbers one at a time from the default, under every
    schedule.
    """
    default = {key: settings["default"][key] for key in KEYS}
    choices = [
        {"ties": ties, "form": form, "alpha0": alpha0}
        for form in settings["forms"]
        for alpha0 in (settings["alpha0"] if form in READ_ALPHA0 else [None])
        for ties in settings["ties"]
    ]
    choices += [{key: n} for key in ("max_steps", "training_tasks") for n in settings[key] if n != default[key]]
    cells = [{**default, "schedule": s, **choice} for s in settings["schedules"] for choice in choices]
    return Grid(default, tuple(cells), {PLAIN: READ_WITHOUT_PRIOR})


def cells(settings: Mapping) -> list[dict]:
    """A run each."""
    return [{"run": number} for number in range(settings["runs"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every method in every cell of the grid."""
    run = run_of(settings, seed, cell["run"])
    optimal = [mean_start_value(task.problem.tables, task.problem.values) for task in run.testing]
    return {**cell, "optimal": float(np.mean(optimal)), "found": list(_all_found(settings, run))}


def _all_found(settings: Mapping, run: Run) -> Iterator[dict]:
    """Numbers of the compared methods in the grid; of priors trained alike, at the default under each schedule."""
    grid = grid_of(settings)
    best = np.mean([start_values(task.problem, settings["episodes"]) for task in run.testing], axis=0)

    @cache
    def prior_of(kind: str, where: str, n_tasks: int, alpha0: float) -> ActionPrior:
        return exact_prior(run.training[where][:n_tasks], kind, alpha0)

    def numbers(method: str, cell: Mapping) -> dict:
        def rows_for(task: Task) -> Rows | None:
            if method == PLAIN:
                return None
            kind, where = METHODS[method]
            prior = prior_of(kind, where, cell["training_tasks"], cell["alpha0"] or 1.0)
            return rows_of(task, prior, kind, cell["form"], cell["ties"])

        schedule = schedule_of({**settings, "max_steps": cell["max_steps"]}, cell["schedule"])
        returns = np.mean([learn_task(task.problem, rows_for(task), schedule)[0] for task in run.testing], axis=0)
        curve = {"curve": block_means(returns)} if grid.is_default_but_for_schedule(cell) else {}
        return {**summary(settings, returns, best), **curve}

    yield from run_grid(grid, "method", PLAIN, COMPARED, numbers)
    for schedule in settings["schedules"]:
        for method in (m for m in METHODS if m not in COMPARED):
            cell = grid.with_schedule(schedule)
            yield {"method": method, **cell, **numbers(method, cell)}


def check(settings: Mapping) -> None:
    """Refuse more training tasks than the lattice has goals, and a falling range of densities."""
    n_states = lattice(settings["size"], settings["discount"]).n_states
    if max(settings["training_tasks"]) > n_states:
        raise InputError(f"training_tasks must be at most the lattice's {n_states} cells that can be goals")
    if settings["density"][0] > settings["density"][1]:
        raise InputError(f"density must be two shares of obstacles, rising, got {settings['density']}")
