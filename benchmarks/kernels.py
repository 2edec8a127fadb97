"""Steps of Q-learning a second: the kernel beside C, a textbook loop and tuned Python; ten thousand learners.

Everyone does the same work unless the name of the row says otherwise. Ten thousand learners of one world take
turns after `CHUNK` steps, so that no table stays in the processor's nearest cache; alone, a learner's does.
"""

import time
from collections.abc import Callable

from benchmarks.lattice import ALPHA, DISCOUNT, EPSILON, MAX_STEPS, kernel_rate, lattice_task, new_case
from benchmarks.peers.c_loop import built_c_loop
from benchmarks.peers.gymnasium_loop import short_textbook_rate, textbook_rate
from benchmarks.peers.list_loop import short_tuned_rate, tuned_rate
from benchmarks.rounds import Part, Rates, at_least, counted, interleaved, joined, paired_ratio, row, row_beside
from lifelore.core.learning.curve import TOTAL
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import learn
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream

KERNEL, C, TEXTBOOK, TUNED = "kernel", "C -O3 -march=native", "Gymnasium + NumPy", "tuned pure Python"
SHORT = ", less work: first best action, no visits"
GOALS = {C: 0.75, TEXTBOOK: 150.0, TUNED: 15.0}
"""Least ratio of the kernel's rate to each rival's that does the same work."""
MANY_GOAL, THREADS_GOAL = 0.9, 1.8
"""Least rate of many learners on one core beside learners that run alone, and of two threads beside one."""
UNIT = "Msteps/s"

LEARNERS, ALONE_LEARNERS = 10_000, 200
STEPS, CHUNK = 5_000, 100
EPISODES = 100
"""Enough for STEPS steps of any learner, few enough that ten thousand curves fit into memory."""
ALONE = "fresh learners, one after the other"
_TURNS = f"{LEARNERS:,} learners in turns of {CHUNK} steps"
MANY, MANY_THREADS = f"{_TURNS}, 1 thread", f"{_TURNS}, 2 threads"
MANY_ROUNDS = 3
"""A round of ten thousand learners costs ten seconds: at most this many rounds of it."""


def bench_kernels(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    contenders = _contenders()
    crowd = {ALONE: alone_rate, MANY: lambda: many_rate(1), MANY_THREADS: lambda: many_rate(2)}
    kernel_rate()  # compiled and warm before anything is timed
    alone_rate(1)
    rounds = min(repeats, MANY_ROUNDS)
    after = counted(progress, repeats * len(contenders) + rounds * len(crowd))
    return joined(_beside(interleaved(contenders, repeats, after)), _many(interleaved(crowd, rounds, after)))


def _contenders() -> dict[str, Callable[[], float]]:
    c_loop = built_c_loop()
    beside = {C: c_loop.rate} if c_loop else {}
    return {
        KERNEL: kernel_rate,
        **beside,
        TEXTBOOK: textbook_rate,
        TEXTBOOK + SHORT: short_textbook_rate,
        TUNED: tuned_rate,
        TUNED + SHORT: short_tuned_rate,
    }


def _beside(rates: Rates) -> Part:
    """The rivals' rows, their ratio to the kernel, and the goals, which are the kernel's ratio to them."""
    rows, goals = [row_beside(KERNEL, rates, UNIT)], []
    for rival in (C, TEXTBOOK, TEXTBOOK + SHORT, TUNED, TUNED + SHORT):
        measured = rival in rates
        if measured:
            rows.append(row_beside(rival, rates, UNIT, KERNEL))
        else:
            rows.append(row(f"{rival}: not measured, no gcc found", None, UNIT, KERNEL))
        if rival in GOALS:
            ratio = paired_ratio(rates[KERNEL], rates[rival]) if measured else None
            goals.append(at_least(f"{KERNEL} / {rival}", GOALS[rival], ratio))
    return rows, goals


def _many(rates: Rates) -> Part:
    """Ten thousand learners beside learners that run alone, and two threads of them beside one."""
    rows = [
        row_beside(ALONE, rates, UNIT),
        row_beside(MANY, rates, UNIT, ALONE),
        row_beside(MANY_THREADS, rates, UNIT, MANY),
    ]
    return rows, [
        at_least(f"{MANY} / alone", MANY_GOAL, rows[1]["ratio"]),
        at_least(f"{MANY_THREADS} / 1 thread", THREADS_GOAL, rows[2]["ratio"]),
    ]


def alone_rate(learners: int = ALONE_LEARNERS) -> float:
    """Million steps a second of learners that run one after the other, each all its steps in one call."""
    cases = [new_case(EPISODES, seed) for seed in range(learners)]
    started = time.perf_counter()
    steps = sum(learn(case.tables, case.rows, case.schedule, case.learner, case.curve, STEPS) for case in cases)
    return steps / (time.perf_counter() - started) / 1e6


def many_rate(threads: int, chunk: int = CHUNK, learners: int = LEARNERS) -> float:
    """Million steps a second of `QLearning.learn_many`, where all run `chunk` steps before any runs the next."""
    method = QLearning(EPISODES, MAX_STEPS, ALPHA, EPSILON, 1.0, EPSILON)
    began: list[tuple[float, int]] = []

    def watch(stacked, _) -> bool:
        began.append((time.perf_counter(), int(stacked.cursor[:, TOTAL].sum())))
        return len(began) * chunk >= STEPS

    worlds, owns = ([stream(seed, "bench", name) for seed in range(learners)] for name in ("world", "own"))
    tables = lattice_task().tables()
    method.learn_many(tables, DISCOUNT, worlds=worlds, owns=owns, threads=threads, chunk=chunk, watch=watch)
    # From the first look on: making ten thousand random states is no learning.
    (first, before), (last, after) = began[0], began[-1]
    return (after - before) / (last - first) / 1e6
