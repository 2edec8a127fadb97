"""Cells of C3.3: learners in noise mazes, each task in its own maze, with priors on percepts or on places.

A run is some tasks on the lattice and some in noise mazes, whose policies make the priors, and test tasks in
other noise mazes. A place is its row and column, so that the lattice's counts can be read in a maze of the same
size; where the lattice had no free cell, a prior on places has no counts. All methods of a run meet the same
mazes, goals and starts, with the same random numbers. Thesis: §3.4.1, Figures 3.4 and 3.5, Alg. 2 and 4.
"""

from collections.abc import Iterator, Mapping
from functools import cache
from typing import NamedTuple

import numpy as np

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learning import Rows
from lifelore.core.planning.planning import mean_start_value
from lifelore.core.streams import stream
from lifelore.domains.grids.lattice import lattice
from lifelore.domains.grids.noise_maze import noise_maze
from reproduction.chapter3.learning import grid_tasks
from reproduction.chapter3.learning.grid_tasks import PERCEPT, PLACE, Problem, exact_prior, rows_of
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.curve_blocks import block_means
from reproduction.engine.grid import READ_WITHOUT_PRIOR, Grid, run_grid

METHODS = {
    "qsap": (PLACE, "lattice"),
    "qpap": (PERCEPT, "noise"),
    "qsap_noise": (PLACE, "noise"),
    "qpap_lattice": (PERCEPT, "lattice"),
}
"""What a prior is conditioned on and where it was trained: the thesis's two, then each trained like the other."""
COMPARED = ("qsap", "qpap")
PLAIN = "q_learning"
KEYS = ("schedule", "ties", "form", "alpha0", "max_steps", "training_tasks")
"""The choices left open that make a cell of the grid."""


class Tasks(NamedTuple):
    """Training tasks by where they lie, and test tasks, all of these in noise mazes."""

    training: dict[str, list[Problem]]
    testing: list[Problem]


def run_of(settings: Mapping, seed: int, number: int) -> Tasks:
    """Run `number`; more training or test tasks leave the first ones as they are."""
    most = max(settings["training_tasks"])
    own = (seed, "C3.3", number)
    world = lattice(settings["size"], settings["discount"])
    goals = stream(*own, "lattice").permutation(world.n_states)[:most]
    on_lattice = [grid_tasks.problem_of(world, int(goal), (*own, "lattice", i)) for i, goal in enumerate(goals)]
    in_mazes = [_in_a_maze(settings, (*own, "training", i)) for i in range(most)]
    testing = [_in_a_maze(settings, (*own, "testing", i)) for i in range(settings["test_tasks"])]
    return Tasks({"lattice": on_lattice, "noise": in_mazes}, testing)


def _in_a_maze(settings: Mapping, names: tuple) -> Problem:
    random = stream(*names, "maze")
    density = float(random.uniform(*settings["density"]))
    world = noise_maze(random, settings["size"], density, discount=settings["discount"])
    return grid_tasks.problem_of(world, int(random.integers(world.n_states)), names)


def grid_of(settings: Mapping) -> Grid:
    """The grid: form × α⁰ × ties under every schedule, and each other cap and number of training tasks.

    α⁰ is crossed only where the form reads it; caps and numbers one at a time from the default, under every
    schedule.
    """
    default = {key: settings["default"][key] for key in KEYS}
    choices = grid_tasks.prior_choices(settings)
    choices += [{key: n} for key in ("max_steps", "training_tasks") for n in settings[key] if n != default[key]]
    cells = [{**default, "schedule": s, **choice} for s in settings["schedules"] for choice in choices]
    return Grid(default, tuple(cells), {PLAIN: READ_WITHOUT_PRIOR})


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every method in every cell of the grid."""
    run = run_of(settings, seed, cell["run"])
    optimal = float(np.mean([mean_start_value(p.tables, p.values) for p in run.testing]))
    return {**cell, "optimal": optimal, "found": list(_all_found(settings, run))}


def _all_found(settings: Mapping, run: Tasks) -> Iterator[dict]:
    """Numbers of the compared methods in the grid; of priors trained alike, at the default under each schedule."""
    grid = grid_of(settings)
    best = np.mean([grid_tasks.start_values(p, settings["episodes"]) for p in run.testing], axis=0)

    @cache
    def prior_of(kind: str, where: str, n_tasks: int, alpha0: float) -> ActionPrior:
        return exact_prior(run.training[where][:n_tasks], alpha0, kind)

    def numbers(method: str, cell: Mapping) -> dict:
        def rows_for(problem: Problem) -> Rows | None:
            if method == PLAIN:
                return None
            kind, where = METHODS[method]
            prior = prior_of(kind, where, cell["training_tasks"], cell["alpha0"] or 1.0)
            return rows_of(problem, prior, cell["form"], cell["ties"], kind)

        schedule = schedule_of({**settings, "max_steps": cell["max_steps"]}, cell["schedule"])
        returns = grid_tasks.mean_returns(run.testing, rows_for, schedule)
        curve = {"curve": block_means(returns)} if grid.is_default_but_for_schedule(cell) else {}
        return {**grid_tasks.summary(settings, returns, best), **curve}

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
