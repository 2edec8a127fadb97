"""Sets of tasks in one domain, solved exactly: lattices, noise mazes, factories and random worlds.

Tasks of a set share states, actions and outcomes (§3.2.2). In a lattice or maze they are goals; in a factory lists
of components, over the configurations of all components that any of them needs; in a random world goals again,
with walls (refused moves) and sinks that no action leaves. Thesis: §3.2.3, §3.4.1, §3.4.2.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.policy_counts import actions_to_count
from lifelore.core.mdp import COLLISION, TERMINAL, Tables
from lifelore.core.planning.layered_planning import layered_q
from lifelore.core.planning.planning import optimal_q
from lifelore.core.streams import stream
from lifelore.domains.factory.factory import ASSEMBLED, FactoryRewards
from lifelore.domains.factory.layout import factory
from lifelore.domains.grids.grid_world import GridWorld
from lifelore.domains.grids.lattice import lattice
from lifelore.domains.grids.noise_maze import noise_maze

KINDS = (
    "lattice, every start",
    "lattice, one start",
    "noise maze, every start",
    "noise maze, one start",
    "factory, 1 component",
    "factory, 2 components",
    "random, few starts",
    "slippery, few starts",
)
GRID_DISCOUNT, FACTORY_DISCOUNT = 0.95, 0.99
FACTORY_COMPONENTS = 3
"""Components of a factory's domain; tasks are the lists of one or of two of them."""
GOAL, WALL = 100.0, -10.0
WALL_SHARE, SINK_SHARE, FEW, RANDOM_ACTIONS = 0.25, 0.15, 2, 4
"""Of a random world: refused moves, states without a way out, starts, and actions."""
SLIP = (0.8, 0.2)


class Solved(NamedTuple):
    """A task: its tables, exact action values, best and tied-best actions, and the name of its streams."""

    tables: Tables
    q: NDArray[np.float64]
    best: NDArray[np.bool_]
    stream: tuple


class TaskSet(NamedTuple):
    """Tasks of one domain, its discount and the step cap of an episode."""

    kind: str
    tasks: list[Solved]
    discount: float
    max_steps: int


def task_set(kind: str, settings: Mapping, names: tuple) -> TaskSet:
    """A set of tasks of one of `KINDS`; `names` of its streams."""
    where, _, starts = kind.partition(", ")
    random = stream(*names, "world")
    if where == "factory":
        tasks = _in_factory(int(starts[0]), random, names)
        return TaskSet(kind, tasks, FACTORY_DISCOUNT, 2 * int(settings["max_steps"]))
    if where in ("random", "slippery"):
        tasks = _in_random(settings, SLIP if where == "slippery" else (1.0,), random, names)
    else:
        size = settings["size"]
        plain = where == "lattice"
        grid = lattice(size, GRID_DISCOUNT) if plain else noise_maze(random, size, discount=GRID_DISCOUNT)
        tasks = _in_grid(grid, starts, settings["tasks"], random, names)
    return TaskSet(kind, tasks, GRID_DISCOUNT, int(settings["max_steps"]))


def _in_random(settings: Mapping, outcomes: Sequence[float], random, names: tuple) -> list[Solved]:
    """Goals that can be reached from every start; worlds with fewer than two are drawn again."""
    n_states = settings["random_states"]
    while True:
        base = random_tables(n_states, RANDOM_ACTIONS, random, outcomes)
        order = random.permutation(n_states)
        starts, tasks = np.sort(order[:FEW]), []
        for goal in order[FEW:].tolist():
            task = _solved(with_goal(base, goal, starts), goal, (*names, goal))
            if (task.q[starts].max(axis=1) > 0).all():
                tasks.append(task)
        if len(tasks) >= 2:
            return tasks[: settings["tasks"]]


def _in_grid(grid: GridWorld, starts: str, n_tasks: int, random, names: tuple) -> list[Solved]:
    drawn = random.permutation(grid.n_states)[: n_tasks + 1]
    start = None if starts == "every start" else drawn[-1:].astype(np.int32)
    goals = drawn[:-1].tolist()
    return [_solved(grid.task(goal, start).tables(), goal, (*names, i)) for i, goal in enumerate(goals)]


def _solved(tables: Tables, goal: int, names: tuple) -> Solved:
    q = optimal_q(tables, GRID_DISCOUNT)
    best = actions_to_count(q, "all", ended=np.arange(tables.n_states) == goal)
    return Solved(tables, q, best, names)


def random_tables(n_states: int, n_actions: int, random, outcomes: Sequence[float]) -> Tables:
    """Where actions lead, each outcome somewhere; a share of moves is refused, a share of states never left."""
    shape = (n_states, n_actions, len(outcomes))
    here = np.broadcast_to(np.arange(n_states)[:, None, None], shape)
    refused = random.random(shape[:2]) < WALL_SHARE
    sinks = random.random(n_states) < SINK_SHARE
    follow = np.where((refused | sinks[:, None])[:, :, None], here, random.integers(n_states, size=shape))
    event = np.where(refused, COLLISION, 0).astype(np.uint8)[:, :, None].repeat(len(outcomes), axis=2)
    cum = np.cumsum(outcomes)
    cum[-1] = 1.0
    return Tables(follow.astype(np.int32), np.where(event > 0, WALL, 0.0), event, cum, np.zeros(1, np.int32))


def with_goal(base: Tables, goal: int, starts) -> Tables:
    """The task of reaching `goal` from elsewhere, which pays and ends the episode."""
    there = (base.next_state == goal) & (np.arange(base.n_states) != goal)[:, None, None]
    event = np.where(there, base.event | TERMINAL, base.event).astype(np.uint8)
    reward = np.where(there, GOAL, base.reward)
    return base._replace(reward=reward, event=event, starts=np.asarray(starts, np.int32))


def _in_factory(k: int, random, names: tuple) -> list[Solved]:
    floor, tasks = factory(discount=FACTORY_DISCOUNT), []
    whole = floor.task(floor.draw_components(random, FACTORY_COMPONENTS))
    base = whole.tables()
    for i, listed in enumerate(combinations(range(FACTORY_COMPONENTS), k)):
        tables, ended = with_list(base, whole.stages, listed)
        q = layered_q(tables, floor.n_cells, FACTORY_DISCOUNT)
        tasks.append(Solved(tables, q, actions_to_count(q, "all", ended=ended), (*names, i)))
    return tasks


def with_list(base: Tables, stages: NDArray[np.int8], listed: Sequence[int]) -> tuple[Tables, NDArray[np.bool_]]:
    """A task of the components at the places `listed` of a factory's, and in which states it is over.

    Using another component's point works as in the domain, but serves no purpose: it is paid as a misuse. `base`
    are the tables of all components, `stages` (n_configurations, n_components).
    """
    pay, n_cells = FactoryRewards(), base.n_states // len(stages)
    over = (stages[:, list(listed)] == ASSEMBLED).all(axis=1)
    ended = np.repeat(over, n_cells)
    before = np.arange(base.n_states)[:, None, None] // n_cells
    after = base.next_state // n_cells
    served = (stages[after] != stages[before])[..., list(listed)].any(axis=-1)
    finished = over[after] & ~ended[:, None, None]
    # All that the union of lists pays or ends is undone first: its own end is not this task's.
    reward = np.where(after == before, base.reward, pay.misuse)
    reward = np.where(served, pay.use + pay.completion * finished, reward)
    reward[ended] = 0.0
    event = np.where(finished | ended[:, None, None], TERMINAL, base.event & ~np.uint8(TERMINAL))
    return base._replace(reward=reward, event=event.astype(np.uint8)), ended
