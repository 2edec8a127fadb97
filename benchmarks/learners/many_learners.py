"""Ten thousand learners of one world in one call, beside learners that run alone: million steps a second.

Everyone does the same work: fresh learners on the lattice, `STEPS` steps each. Alone, a learner's tables lie in
the processor's nearest cache; of ten thousand that take turns after 100 steps, none does.
"""

import time

from benchmarks.learners.lattice_case import (
    ALPHA,
    DISCOUNT,
    EPSILON,
    MAX_STEPS,
    lattice_task,
    new_case,
)
from lifelore.core.learning.curve import TOTAL
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import learn
from lifelore.core.streams import stream

LEARNERS, ALONE = 10_000, 200
STEPS, CHUNK = 5_000, 100
EPISODES = 100
"""Enough for STEPS steps of anyone, few enough that ten thousand curves fit into memory."""


def alone_rate(learners: int = ALONE) -> float:
    """Of learners that run one after the other, each all its steps in one call of the kernel."""
    cases = [new_case(EPISODES, seed) for seed in range(learners)]
    started = time.perf_counter()
    steps = sum(learn(case.tables, case.rows, case.schedule, case.learner, case.curve, STEPS) for case in cases)
    return steps / (time.perf_counter() - started) / 1e6


def many_rate(threads: int, chunk: int = CHUNK, learners: int = LEARNERS) -> float:
    """Of `QLearning.learn_many`, where all learners have run `chunk` steps before any runs the next."""
    method = QLearning(EPISODES, MAX_STEPS, ALPHA, EPSILON, 1.0, EPSILON)
    began: list[tuple[float, int]] = []

    def watch(stacked, _) -> bool:
        began.append((time.perf_counter(), int(stacked.cursor[:, TOTAL].sum())))
        return len(began) * chunk >= STEPS

    streams = [[stream(seed, "bench", name) for seed in range(learners)] for name in ("world", "own")]
    method.learn_many(
        lattice_task().tables(),
        DISCOUNT,
        worlds=streams[0],
        owns=streams[1],
        threads=threads,
        chunk=chunk,
        watch=watch,
    )
    # From the first look on: making ten thousand random states is no learning.
    (first, before), (last, after) = began[0], began[-1]
    return (after - before) / (last - first) / 1e6
