"""The work that is timed: ε-greedy Q-learning on the thesis's 23×23 lattice, 341 cells, 4 actions.

All that are compared do the same work unless the name of the row says otherwise: ties between best actions are
broken at random, visits are counted, and each episode's return, reward, steps and collisions are kept.
"""

import time
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np

from lifelore.core.learning.curve import Curve, new_curve
from lifelore.core.learning.q_learning import QLearner, Rows, Schedule, learn, new_learner, uniform_rows
from lifelore.core.mdp import Tables
from lifelore.core.streams import stream
from lifelore.domains.grids.lattice import lattice

EPSILON, ALPHA, MAX_STEPS, DISCOUNT = 0.1, 0.1, 1000, 0.95
EPISODES, LEARNERS = 4000, 5
GOAL = 0
"""A corner of the lattice."""


class Case(NamedTuple):
    """A learner before its first step, and all it needs."""

    tables: Tables
    rows: Rows
    schedule: Schedule
    learner: QLearner
    curve: Curve


@cache
def lattice_task():
    """The lattice with its goal in a corner."""
    return lattice(23, discount=DISCOUNT).task(GOAL)


def new_case(episodes: int = EPISODES, seed: int = 0) -> Case:
    """A fresh learner; the same seed learns the same."""
    tables = lattice_task().tables()
    schedule = Schedule(np.full(episodes, EPSILON), np.full(episodes, ALPHA), MAX_STEPS, DISCOUNT)
    learner = new_learner(
        tables.n_states, tables.n_actions, stream(seed, "bench", "world"), stream(seed, "bench", "own")
    )
    return Case(tables, uniform_rows(tables), schedule, learner, new_curve(episodes))


def run_kernel(case: Case) -> int:
    """Learn all episodes of `case` in place; returns the number of steps."""
    return learn(case.tables, case.rows, case.schedule, case.learner, case.curve, 10**12)


def kernel_rate() -> float:
    """Million steps a second of the kernel, over fresh learners."""
    return timed(run_kernel)


def timed(run: Callable[[Case], int]) -> float:
    """Million steps a second of `run` over fresh learners; making them takes no part."""
    cases = [new_case(seed=seed) for seed in range(LEARNERS)]
    started = time.perf_counter()
    steps = sum(map(run, cases))
    return steps / (time.perf_counter() - started) / 1e6
