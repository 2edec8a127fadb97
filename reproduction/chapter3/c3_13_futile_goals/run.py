"""C3.13: how often exploration by a prior enters a goal that was futile in all tasks so far (Eq. 3.6).

In a constructed world one action of one junction leads to the new goal, and all others are tied best there in
every task: the worst case. Its tasks are goals along a chain, solved exactly. For a prior by percepts several
junctions look alike, and only one of them has the new goal beside it. Random worlds, lattices and noise mazes
have whatever their tasks make of them. Frequencies are those of the learner's own kernel, which learns nothing
and starts again after every step. Thesis: §3.2.3, Eq. 3.6.
"""

from collections.abc import Iterator, Mapping
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.action.priors.policy_counts import actions_to_count
from lifelore.action.search.domain_reduction import domain_futile_states, futile_goal_probability
from lifelore.core.errors import InputError
from lifelore.core.learning.curve import new_curve
from lifelore.core.learning.q_learning import Rows, Schedule, learn, new_learner, uniform_rows
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.planning.planning import optimal_q
from lifelore.core.streams import stream
from lifelore.domains.grids.lattice import lattice
from lifelore.domains.grids.noise_maze import noise_maze

DISCOUNT = 0.95
ROUNDING = 1e-12
"""Relative distance below a bound that counts as rounding."""


class Constructed(NamedTuple):
    """A constructed world: successors, goals of its tasks in order, and the new goal."""

    follow: NDArray[np.int32]
    goals: list[int]
    new_goal: int


def constructed(n_actions: int, n_tasks: int, alike: int, leading: int) -> Constructed:
    """Junctions 0 to `alike` - 1, a room after them, a chain of `n_tasks` goals, then the new goal.

    Action `leading` takes junction 0 to the new goal and keeps the other junctions where they are; every other
    action of a junction leads to the room, and from there one way leads along the chain and back to junction 0.
    """
    room, new_goal = alike, alike + n_tasks + 1
    follow = np.empty((new_goal + 1, n_actions), np.int32)
    follow[:alike] = room
    follow[:alike, leading] = np.arange(alike)
    follow[0, leading] = new_goal
    follow[room:new_goal] = np.arange(room + 1, new_goal + 1)[:, None]
    follow[[new_goal - 1, new_goal]] = 0
    return Constructed(follow, list(range(room + 1, new_goal)), new_goal)


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
    """Every number of actions, α⁰, number of tasks and of junctions that look alike.

    At the default also how often the action is taken where only a tenth of the steps explore and Q is 0.
    """
    default, draws = settings["default"], settings["draws"]
    for n_actions, alike in product(settings["actions"], (1, *settings["alike"])):
        leading = int(stream(seed, "C3.13", run, "leading", n_actions).integers(n_actions))
        world = constructed(n_actions, max(settings["tasks"]), alike, leading)
        solved = [best_in(goal_tables(world.follow, goal, np.arange(alike)), goal) for goal in world.goals]
        contexts = np.maximum(np.arange(len(world.follow)) - alike + 1, 0)  # junctions are one percept
        tables = goal_tables(world.follow, world.new_goal, [0])
        for alpha0, n_tasks in product(settings["alpha0"], sorted(settings["tasks"])):
            prior = ActionPrior(n_actions, alpha0)
            for best in solved[:n_tasks]:
                prior.update(contexts, best)
            names = (seed, "C3.13", run, alike, n_actions, str(alpha0), n_tasks)
            case = {"actions": n_actions, "alike": alike, "alpha0": alpha0, "tasks": n_tasks}
            case["formula"] = float(futile_goal_probability(n_actions, n_tasks * alike, alpha0))
            case["prior"] = float(prior.probs(contexts[:1])[0, leading])
            case["taken"] = frequency(tables, prior_rows(tables, contexts, prior.probs), 1.0, draws, names)
            if alike == 1 and (n_actions, alpha0) == (default["actions"], default["alpha0"]):
                for ties in ("uniform", "prior"):
                    rows = prior_rows(tables, contexts, prior.probs, ties)
                    case[f"taken_{ties}_ties"] = frequency(tables, rows, 0.1, draws, names)
            yield case


def world_of(kind: str, settings: Mapping, names: tuple) -> tuple[NDArray, NDArray, NDArray]:
    """Successors, percepts and starts of a random world, a lattice or a noise maze.

    It has few starts, so that much of it is futile.
    """
    random = stream(*names, "world")
    if kind == "random":
        n_states, n_actions = settings["states"], int(random.choice([2, 4]))
        follow = random.integers(n_states, size=(n_states, n_actions)).astype(np.int32)
        percepts = random.integers(max(2, n_states // 4), size=n_states)
    else:
        size = settings["size"]
        grid = lattice(size) if kind == "lattice" else noise_maze(random, size)
        here = np.arange(grid.n_states, dtype=np.int32)[:, None]
        follow, percepts = np.where(grid.neighbour < 0, here, grid.neighbour).astype(np.int32), grid.percepts
    starts = random.choice(len(follow), size=2, replace=False).astype(np.int32)
    return follow, percepts, np.sort(starts)


def found_case(kind: str, settings: Mapping, names: tuple, n_tasks: int) -> dict | None:
    """Actions that lead from kept states into goals futile so far, by both priors; None where there are none."""
    (follow, percepts, starts), alpha0 = world_of(kind, settings, names), settings["default"]["alpha0"]
    n_states, n_actions = follow.shape
    goals = stream(*names, "goals").permutation(n_states)[:n_tasks].tolist()
    tasks = [goal_tables(follow, goal, starts) for goal in goals]
    policies = [best_in(task, goal) for task, goal in zip(tasks, goals, strict=True)]
    futile = domain_futile_states(tasks, policies)
    entering = ~futile[:, None] & futile[follow]
    if not entering.any():
        return None
    probs = {}
    for name, contexts in (("state", np.arange(n_states)), ("percept", percepts)):
        prior = ActionPrior(n_actions, alpha0)
        for best in policies:
            prior.update(contexts, best)
        probs[name] = prior.probs(contexts)
    percept = np.unique(percepts, return_inverse=True)[1]
    alike = np.bincount(percept)[percept]
    bound = float(futile_goal_probability(n_actions, n_tasks, alpha0))
    pooled = futile_goal_probability(n_actions, n_tasks * alike, alpha0)[:, None]

    def below(name, least):
        return int((probs[name] < least * (1 - ROUNDING))[entering].sum())

    s, a = map(int, np.unravel_index(np.where(entering, probs["state"], 2.0).argmin(), entering.shape))
    # Steps from s that end where a leads, by whichever action.
    step = goal_tables(follow, int(follow[s, a]), [s])
    rows = uniform_rows(step, probs["state"])
    return {
        "kind": kind,
        "tasks": n_tasks,
        "entering": int(entering.sum()),
        "below_states": below("state", bound),
        "below_percepts": below("percept", bound),
        "below_percepts_pooled": below("percept", pooled),
        "bound": bound,
        "least": float(probs["state"][s, a]),
        "least_percepts": float(probs["percept"][entering].min()),
        "expected": float(probs["state"][s][follow[s] == follow[s, a]].sum()),
        "taken": frequency(step, rows, 1.0, settings["draws"], (*names, "taken")),
    }


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


def check(settings: Mapping) -> None:
    if 0 not in settings["tasks"] or len([n for n in set(settings["tasks"]) if n]) < 2:
        raise InputError(f"tasks must hold 0 and two other numbers, for the decay, got {settings['tasks']}")
