"""`bench kernels`: the Q-learning kernel beside C, a textbook loop and tuned Python; many learners; threads."""

from collections.abc import Callable
from statistics import median

from benchmarks.learners.c_loop import built_c_loop
from benchmarks.learners.gymnasium_loop import short_textbook_rate, textbook_rate
from benchmarks.learners.lattice_case import kernel_rate
from benchmarks.learners.list_loop import short_tuned_rate, tuned_rate
from benchmarks.learners.many_learners import CHUNK, LEARNERS, alone_rate, many_rate
from benchmarks.learners.thread_scaling import THREADS, check_same_bits, threaded_rate
from benchmarks.rounds import Rates, at_least, interleaved, paired_ratio, row
from lifelore.core.protocols import Progress

KERNEL, C, TEXTBOOK, TUNED = "kernel", "C -O3 -march=native", "Gymnasium + NumPy", "tuned pure Python"
SHORT = ", less work: first best action, no visits"
GOALS = {C: 0.75, TEXTBOOK: 150.0, TUNED: 15.0}
"""Least ratio of the kernel's rate to each rival's that does the same work."""
MANY_GOAL, THREADS_GOAL = 0.9, 1.8
"""Least rate of many learners on one core beside learners that run alone, and of two threads beside one."""
UNIT = "Msteps/s"


ONE, SEVERAL = "8 learners, 1 thread", f"8 learners, {THREADS} threads"
ALONE = "fresh learners, one after the other"
_TURNS = f"{LEARNERS:,} learners in turns of {CHUNK} steps"
MANY, MANY_THREADS = f"{_TURNS}, 1 thread", f"{_TURNS}, 2 threads"
MANY_ROUNDS = 3
"""A round of ten thousand learners costs ten seconds: at most this many rounds of it."""


def bench_kernels(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    contenders = _contenders()
    crowd = {ALONE: alone_rate, MANY: lambda: many_rate(1), MANY_THREADS: lambda: many_rate(2)}
    check_same_bits()
    kernel_rate()  # compiled and warm before anything is timed
    alone_rate(1)
    rounds = min(repeats, MANY_ROUNDS)
    total = repeats * len(contenders) + rounds * len(crowd)
    done = 0

    def after(label: str) -> None:
        nonlocal done
        done += 1
        progress(done, total, label)

    rates = interleaved(contenders, repeats, after)
    rate_rows, rate_goals = _beside(rates)
    threads = [
        row(ONE, median(rates[ONE]), UNIT),
        row(SEVERAL, median(rates[SEVERAL]), UNIT, ONE, paired_ratio(rates[SEVERAL], rates[ONE])),
    ]
    many_rows, many_goals = _many(interleaved(crowd, rounds, after))
    return {"rows": [*rate_rows, *threads, *many_rows], "goals": [*rate_goals, *many_goals]}


def _many(rates: Rates) -> tuple[list[dict], list[dict]]:
    """Ten thousand learners beside learners that run alone, and two threads of them beside one."""
    to_alone = paired_ratio(rates[MANY], rates[ALONE])
    to_one_thread = paired_ratio(rates[MANY_THREADS], rates[MANY])
    rows = [
        row(ALONE, median(rates[ALONE]), UNIT),
        row(MANY, median(rates[MANY]), UNIT, ALONE, to_alone),
        row(MANY_THREADS, median(rates[MANY_THREADS]), UNIT, MANY, to_one_thread),
    ]
    goals = [
        at_least(f"{MANY} / alone", MANY_GOAL, to_alone),
        at_least(f"{MANY_THREADS} / 1 thread", THREADS_GOAL, to_one_thread),
    ]
    return rows, goals


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
        ONE: lambda: threaded_rate(1),
        SEVERAL: lambda: threaded_rate(THREADS),
    }


def _beside(rates: Rates) -> tuple[list[dict], list[dict]]:
    """The rivals' rows, their ratio to the kernel, and the goals, which are the kernel's ratio to them."""
    rows, goals = [row(KERNEL, median(rates[KERNEL]), UNIT)], []
    for rival in (C, TEXTBOOK, TEXTBOOK + SHORT, TUNED, TUNED + SHORT):
        ours_to_theirs = None
        if rival in rates:
            theirs_to_ours = paired_ratio(rates[rival], rates[KERNEL])
            ours_to_theirs = paired_ratio(rates[KERNEL], rates[rival])
            rows.append(row(rival, median(rates[rival]), UNIT, KERNEL, theirs_to_ours))
        else:
            rows.append(row(f"{rival}: not measured, no gcc found", None, UNIT, KERNEL))
        if rival in GOALS:
            goals.append(at_least(f"{KERNEL} / {rival}", GOALS[rival], ours_to_theirs))
    return rows, goals
