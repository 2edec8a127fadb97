"""What grows with a fleet: many Q-learners, many contexts of a prior, many contributions of a memory."""

import tempfile
import time
import tracemalloc
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import TypeVar

import numpy as np

from benchmarks.learners.lattice_case import ALPHA, DISCOUNT, EPSILON, MAX_STEPS, lattice_task
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.live.lore import Lore, prior_scope
from lifelore.core.learning.curve import EPISODE, new_curve
from lifelore.core.learning.q_learning import Rows, Schedule, learn_each, new_learners, uniform_rows
from lifelore.core.mdp import Tables, Task
from lifelore.core.planning.planning import best_actions, optimal_q
from lifelore.core.streams import stream
from lifelore.domains import make_world
from lifelore.memory import open_memory

TURN = 1000
"""Steps of a learner before it is the next one's turn."""
EPISODES = 100
"""Most episodes of a turn whose course is kept; a turn of a learner that knows the way has some 40."""
LEAST_STEPS = 2_000_000
"""Steps that a rate is measured over."""
LEAST_CONTEXTS = 200_000
"""Contexts counted or sampled that a rate is measured over."""
ACTIONS, ALPHA0, CHOSEN = 4, 0.1, 0.4
LARGE = 801
"""Cells a side of the lattice whose moves are counted: 1.9 million moves."""
GOALS = 20
"""Tasks whose lessons are contributed, over and over."""
T = TypeVar("T")


def bytes_of(make: Callable[[], T]) -> tuple[T, int]:
    """Something made, and the bytes that Python and NumPy hold for it."""
    tracemalloc.start()
    try:
        before, _ = tracemalloc.get_traced_memory()
        made = make()
        after, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    return made, after - before


# ---- learners --------------------------------------------------------------------------------------------


class Learners:
    """`n` Q-learners of the 23×23 lattice, each with a table, random streams and a curve of its own."""

    def __init__(self, n: int) -> None:
        tables, rows, schedule = _shared()
        world, own = (stream(0, "bench", "capacity", name) for name in ("world", "own"))
        self._shared = tables, rows, schedule
        self.n = n
        self.learners = new_learners(tables.n_states, tables.n_actions, [world] * n, [own] * n)
        self.curves = new_curve((n, EPISODES))

    def advance(self) -> int:
        """A turn of every learner; returns the steps of all."""
        self.learners.cursor[:, EPISODE] = 0  # the course of a turn is kept, not of a life
        return learn_each(*self._shared, self.learners, self.curves, TURN, 0, self.n)

    def rate(self) -> float:
        """Steps a second of all together, in turns."""
        steps, started = 0, time.thread_time()
        for _ in range(max(1, LEAST_STEPS // (TURN * self.n))):
            steps += self.advance()
        return steps / (time.thread_time() - started)


@cache
def _shared() -> tuple[Tables, Rows, Schedule]:
    """What all learners of the lattice read."""
    tables = lattice_task().tables()
    schedule = Schedule(np.full(EPISODES, EPSILON), np.full(EPISODES, ALPHA), MAX_STEPS, DISCOUNT)
    return tables, uniform_rows(tables), schedule


def move_rate() -> float:
    """Moves a second of one core: `step` for every (state, action) of a large lattice at once."""
    task = _large_lattice()
    started = time.thread_time()
    tables = task.tables()
    return tables.next_state.size / (time.thread_time() - started)


@cache
def _large_lattice() -> Task:
    return make_world("lattice", size=LARGE).task(goal=0)


# ---- contexts --------------------------------------------------------------------------------------------


class Contexts:
    """A prior that has counted each of `n` scattered codes once."""

    def __init__(self, n: int) -> None:
        random = stream(0, "bench", "capacity", "contexts", n)
        self.codes = random.permutation(np.unique(random.integers(0, 2**60, n + n // 100 + 1))[:n])
        self.best = random.random((n, ACTIONS)) < CHOSEN
        self.best[:, 0] |= ~self.best.any(axis=1)
        self._random = random
        self._counted()  # compiled before its bytes are counted
        self.prior, self.bytes = bytes_of(self._counted)

    def _counted(self) -> ActionPrior:
        prior = ActionPrior(ACTIONS, ALPHA0)
        prior.update(self.codes, self.best)
        prior.sample(self.codes, np.random.default_rng(0))  # with what it builds to look codes up
        return prior

    def updates(self) -> float:
        """Contexts a second that are counted once more."""
        return self._rate(lambda: self.prior.update(self.codes, self.best))

    def samples(self) -> float:
        """Contexts a second for which an action is drawn."""
        return self._rate(lambda: self.prior.sample(self.codes, self._random))

    def _rate(self, run: Callable[[], object]) -> float:
        n = len(self.codes)
        times = max(1, LEAST_CONTEXTS // n)
        started = time.thread_time()
        for _ in range(times):
            run()
        return times * n / (time.thread_time() - started)


# ---- contributions ---------------------------------------------------------------------------------------


def contributions(numbers: Sequence[int]) -> dict[int, dict[str, float]]:
    """A new memory after each number of contributions: ``bytes`` of it, ``seconds`` of one, ``seconds_of_all``.

    A contribution is what a task in an office teaches: best actions by what is perceived.
    """
    world = make_world("building")
    scope = prior_scope(world, "observation")
    found: dict[int, dict[str, float]] = {}
    with tempfile.TemporaryDirectory() as folder:
        path, done, spent = Path(folder) / "fleet.db", 0, 0.0
        with open_memory(path) as memory:
            lore = Lore.recalled(world, scope, ALPHA0, memory)
        goals = stream(0, "bench", "capacity", "goals").integers(0, world.n_states, GOALS).tolist()
        lessons = [_lesson(lore, goal) for goal in goals]
        for number in sorted(numbers):
            started = time.perf_counter()
            with open_memory(path) as memory:
                for seq in range(done, number):
                    goal = goals[seq % GOALS]
                    about = {"index": seq, "goal": world.cells[goal].tolist(), "world": world.fingerprint}
                    memory.contribute("robot", [lessons[seq % GOALS]], process="bench", seq=seq, task=about)
            seconds = time.perf_counter() - started
            spent += seconds
            # Closed, the memory is one file: what SQLite keeps beside it is gone.
            found[number] = {
                "bytes": sum(file.stat().st_size for file in path.parent.iterdir()),
                "seconds": seconds / (number - done),
                "seconds_of_all": spent,
            }
            done = number
    return found


def _lesson(lore: Lore, goal: int):
    task = lore.world.task(goal)
    best = best_actions(optimal_q(task.tables(), task.domain.discount))
    return lore.learn_prior(best, goal, 1.0)
