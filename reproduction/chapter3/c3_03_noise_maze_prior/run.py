"""C3.3: learners in noise mazes, each task in its own maze, with priors on percepts or on places.

The percept prior is of other noise mazes, the state prior of the lattice. A place is its row and column, so that
the lattice's counts can be read in a maze of the same size; where the lattice had no free cell, a prior on places
has no counts. All methods of a run meet the same mazes, goals and starts, with the same random numbers.
Thesis: §3.4.1, Figures 3.4 and 3.5, Alg. 2 and 4.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.streams import stream
from lifelore.domains.grids.lattice import lattice
from lifelore.domains.grids.noise_maze import noise_maze
from reproduction.chapter3.figures.return_curves import draw_return_curves
from reproduction.chapter3.learning import grid_tasks
from reproduction.chapter3.learning.grid_tasks import PERCEPT, PLACE, PLAIN, Problem, Trained

PAIRS = {"qpap": ("qpap", PLAIN), "qpap_to_qsap": ("qpap", "qsap"), "qsap": ("qsap", PLAIN)}
"""Compared methods, the first with the second, by the beginning of their measures."""
rows = grid_tasks.curve_rows


class Tasks(NamedTuple):
    """Training tasks by where they lie, and test tasks, all of these in noise mazes."""

    lattice: list[Problem]
    noise: list[Problem]
    testing: list[Problem]


def run_of(settings: Mapping, seed: int, number: int) -> Tasks:
    """Run `number`; more training or test tasks leave the first ones as they are."""
    n_tasks, own = settings["training_tasks"], (seed, "C3.3", number)
    world = lattice(settings["size"], settings["discount"])
    goals = stream(*own, "lattice").permutation(world.n_states)[:n_tasks]
    on_lattice = [grid_tasks.problem_of(world, int(goal), (*own, "lattice", i)) for i, goal in enumerate(goals)]
    in_mazes = [_in_a_maze(settings, (*own, "training", i)) for i in range(n_tasks)]
    testing = [_in_a_maze(settings, (*own, "testing", i)) for i in range(settings["testing_tasks"])]
    return Tasks(on_lattice, in_mazes, testing)


def _in_a_maze(settings: Mapping, names: tuple) -> Problem:
    random = stream(*names, "maze")
    density = float(random.uniform(*settings["density"]))
    world = noise_maze(random, settings["size"], density, discount=settings["discount"])
    return grid_tasks.problem_of(world, int(random.integers(world.n_states)), names)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: Q-learning and learners with both priors, by choice."""
    run = run_of(settings, seed, cell["run"])
    trained = {"qsap": Trained(PLACE, run.lattice), "qpap": Trained(PERCEPT, run.noise)}
    return {**cell, **grid_tasks.learnt_by_choice(settings, run.testing, trained, cell["run"])}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Each method's episodes to 80 % at the default."""
    to_80 = {f"to_80_{name}": grid_tasks.at_default(results, "to_80", name) for name in (PLAIN, "qsap", "qpap")}
    return {**to_80, "optimal_return": mean_estimate([result["optimal"] for result in results])}


def _numbers(results: Sequence[Mapping], place: int) -> dict[str, Estimate]:
    return {
        f"{name}_{measure}": number
        for name, pair in PAIRS.items()
        for measure, number in grid_tasks.compared(results, place, *pair).items()
        if measure != "to_50_ratio"
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The comparisons by schedule, ties, form and α⁰."""
    for place, choice in enumerate(grid_tasks.choices_of(settings)):
        yield choice, _numbers(results, place)


def check(settings: Mapping) -> None:
    """Refuse a density that is no range of shares."""
    density = settings["density"]
    if len(density) != 2 or not 0 <= density[0] <= density[1] < 1:
        raise InputError(f"density must be two shares of obstacles, rising, got {density}")


METHODS = {
    "q_learning": ("Q-learning", "q-learning"),
    "qsap": ("ε-QSAP, from the lattice", "eps-QSAP"),
    "qpap": ("ε-QPAP, from noise mazes", "eps-QPAP"),
}

draw = partial(draw_return_curves, methods=METHODS)
"""Figure of claim C3.3: the thesis's Figure 3.5, returns of ε-QPAP, ε-QSAP and Q-learning in noise mazes."""
