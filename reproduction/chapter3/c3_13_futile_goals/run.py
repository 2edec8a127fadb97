"""C3.13: how often exploration by a prior enters a goal that was futile in all tasks so far (Eq. 3.6).

In a constructed world one action of one junction leads to the new goal, and all others are tied best there in
every task: the worst case. Its tasks are goals along a chain, solved exactly. Random worlds, lattices and noise
mazes have whatever their tasks make of them. Frequencies are those of the learner's own kernel, which learns
nothing and starts again after every step. Thesis: §3.2.3, Eq. 3.6.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.action.priors.policy_counts import actions_to_count
from lifelore.action.search.domain_reduction import domain_futile_states, futile_goal_probability
from lifelore.core.learning.curve import new_curve
from lifelore.core.learning.q_learning import Rows, Schedule, learn, new_learner
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.planning.planning import optimal_q
from lifelore.core.streams import stream
from lifelore.domains.grids.lattice import lattice
from lifelore.domains.grids.noise_maze import noise_maze
from reproduction.engine.estimates import exact_value, mean_or_unmeasured

DISCOUNT = 0.95
ROUNDING = 1e-12
"""Relative distance below a bound that counts as rounding."""


class Constructed(NamedTuple):
    """A constructed world: successors, goals of its tasks in order, and the new goal."""

    follow: NDArray[np.int32]
    goals: list[int]
    new_goal: int


def constructed(n_actions: int, n_tasks: int, leading: int) -> Constructed:
    """Junction 0, a room, a chain of `n_tasks` goals, then the new goal.

    Action `leading` takes the junction to the new goal, every other action to the room; from there one way leads
    along the chain and back to the junction.
    """
    new_goal = n_tasks + 2
    follow = np.repeat(np.arange(1, new_goal + 2, dtype=np.int32)[:, None], n_actions, axis=1)
    follow[0, leading] = new_goal
    follow[[new_goal - 1, new_goal]] = 0
    return Constructed(follow, list(range(2, new_goal)), new_goal)


def goal_tables(follow: NDArray[np.int32], goal: int, starts) -> Tables:
    """A task of the world: reach `goal`, which pays 1 and ends the episode."""
    there = (follow == goal)[:, :, None]
    event = np.where(there, TERMINAL, 0).astype(np.uint8)
    return Tables(follow[:, :, None], there.astype(float), event, np.ones(1), np.asarray(starts, np.int32))


def best_in(tables: Tables, goal: int) -> NDArray[np.bool_]:
    """Optimal actions of every state, tied ones too, none in the goal."""
    ended = np.arange(tables.n_states) == goal
    return actions_to_count(optimal_q(tables, DISCOUNT), "all", ended=ended)


def frequency(tables: Tables, rows: Rows, epsilon: float, draws: int, names: tuple) -> int:
    """Of `draws` single steps from the task's start, how many end the episode."""
    learner = new_learner(tables.n_states, tables.n_actions, stream(*names, "world"), stream(*names, "own"))
    curve = new_curve(draws)
    learn(tables, rows, Schedule(np.full(draws, epsilon), np.zeros(draws), 1, DISCOUNT), learner, curve, draws)
    return int(curve.reached.sum())


def constructed_cases(settings: Mapping, seed: int, run: int) -> Iterator[dict]:
    """Every number of actions, α⁰ and number of tasks, none among them."""
    draws, numbers = settings["draws"], sorted({0, *settings["tasks"]})
    for n_actions in settings["actions"]:
        leading = int(stream(seed, "C3.13", run, "leading", n_actions).integers(n_actions))
        world = constructed(n_actions, max(numbers), leading)
        states, tables = np.arange(len(world.follow)), goal_tables(world.follow, world.new_goal, [0])
        solved = [best_in(goal_tables(world.follow, goal, [0]), goal) for goal in world.goals]
        for alpha0, n_tasks in product(settings["alpha0"], numbers):
            prior = ActionPrior(n_actions, alpha0)
            for best in solved[:n_tasks]:
                prior.update(states, best)
            names = (seed, "C3.13", run, n_actions, str(alpha0), n_tasks)
            yield {
                "actions": n_actions,
                "alpha0": alpha0,
                "tasks": n_tasks,
                "formula": float(futile_goal_probability(n_actions, n_tasks, alpha0)),
                "prior": float(prior.probs(states[:1])[0, leading]),
                "taken": frequency(tables, prior_rows(tables, states, prior.probs), 1.0, draws, names),
            }


def world_of(kind: str, settings: Mapping, names: tuple) -> tuple[NDArray, NDArray]:
    """Successors and starts of a random world, a lattice or a noise maze.

    It has few starts, so that much of it is futile.
    """
    random = stream(*names, "world")
    if kind == "random":
        n_states, n_actions = settings["states"], int(random.choice([2, 4]))
        follow = random.integers(n_states, size=(n_states, n_actions)).astype(np.int32)
    else:
        size = settings["size"]
        grid = lattice(size) if kind == "lattice" else noise_maze(random, size)
        here = np.arange(grid.n_states, dtype=np.int32)[:, None]
        follow = np.where(grid.neighbour < 0, here, grid.neighbour).astype(np.int32)
    starts = random.choice(len(follow), size=2, replace=False).astype(np.int32)
    return follow, np.sort(starts)


def found_case(kind: str, settings: Mapping, names: tuple, n_tasks: int) -> dict | None:
    """Actions that lead from kept states into goals futile so far; None where there are none."""
    (follow, starts), alpha0 = world_of(kind, settings, names), settings["alpha0"][0]
    n_states, n_actions = follow.shape
    goals = stream(*names, "goals").permutation(n_states)[:n_tasks].tolist()
    tasks = [goal_tables(follow, goal, starts) for goal in goals]
    policies = [best_in(task, goal) for task, goal in zip(tasks, goals, strict=True)]
    futile = domain_futile_states(tasks, policies)
    entering = ~futile[:, None] & futile[follow]
    if not entering.any():
        return None
    prior = ActionPrior(n_actions, alpha0)
    for best in policies:
        prior.update(np.arange(n_states), best)
    probs = prior.probs(np.arange(n_states))[entering]
    bound = float(futile_goal_probability(n_actions, n_tasks, alpha0))
    below = int((probs < bound * (1 - ROUNDING)).sum())
    numbers = {"entering": len(probs), "below": below, "least": float(probs.min()) / bound}
    return {"kind": kind, "tasks": n_tasks, **numbers}


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every constructed case, and some worlds of each kind with each number of tasks."""
    names = (seed, "C3.13", cell["run"])
    found = [
        found_case(kind, settings, (*names, kind, n_tasks, i), n_tasks)
        for kind, n_tasks in product(settings["kinds"], settings["found_tasks"])
        for i in range(settings["worlds"])
    ]
    cases = list(constructed_cases(settings, seed, cell["run"]))
    return {**cell, "constructed": cases, "found": [case for case in found if case]}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The prior and the measured frequency over Eq. 3.6, its decay, and actions of random worlds below it."""
    cases = [case for result in results for case in result["constructed"]]
    worlds = [world for result in results for world in result["found"]]
    below, entering = (sum(world[key] for world in worlds) for key in ("below", "entering"))
    return {
        "prior_error": exact_value(max(abs(c["prior"] / c["formula"] - 1) for c in cases), len(cases)),
        "frequency_ratio": mean_estimate(_ratios(settings, results, lambda n_tasks: n_tasks > 0)),
        "frequency_ratio_no_task": mean_estimate(_ratios(settings, results, lambda n_tasks: n_tasks == 0)),
        "slope": mean_or_unmeasured(_slopes(settings, results)),
        "share_below": exact_value(below / max(1, entering), entering),
    }


def _ratios(settings: Mapping, results: Sequence[Mapping], wanted: Callable[[int], bool]) -> list[float]:
    """For each run, the measured frequency over Eq. 3.6, a mean over the cases of the `wanted` tasks."""
    cases = [[case for case in result["constructed"] if wanted(case["tasks"])] for result in results]
    return [float(np.mean([c["taken"] / (settings["draws"] * c["formula"]) for c in of_run])) for of_run in cases]


def _slopes(settings: Mapping, results: Sequence[Mapping]) -> list[float]:
    """The measured slope for the first |A| and α⁰, run by run; without runs that had no hit after some tasks."""
    first, slopes = (settings["actions"][0], settings["alpha0"][0]), []
    for result in results:
        cases = [c for c in result["constructed"] if c["tasks"] and (c["actions"], c["alpha0"]) == first]
        if len(cases) > 1 and all(case["taken"] for case in cases):
            slopes.append(slope([c["tasks"] for c in cases], [c["taken"] for c in cases]))
    return slopes


def slope(tasks: Sequence[int], frequencies: Sequence[float]) -> float:
    """Least-squares slope of the logarithm of `frequencies` over that of `tasks`."""
    return float(np.polyfit(np.log(tasks), np.log(frequencies), 1)[0])
