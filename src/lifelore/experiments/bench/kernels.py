"""`bench kernels`: the Q-learning kernel beside C, a textbook loop and tuned Python; and the time to start."""

from collections.abc import Callable
from statistics import median

from lifelore.core.protocols import Progress
from lifelore.experiments.bench.c_loop import built_c_loop
from lifelore.experiments.bench.first_result import LEARNERS, first_result_seconds, help_seconds
from lifelore.experiments.bench.gymnasium_loop import short_textbook_rate, textbook_rate
from lifelore.experiments.bench.lattice_case import kernel_rate
from lifelore.experiments.bench.list_loop import short_tuned_rate, tuned_rate
from lifelore.experiments.bench.rounds import Rates, at_least, at_most, interleaved, paired_ratio, row
from lifelore.experiments.bench.thread_scaling import THREADS, check_same_bits, threaded_rate

KERNEL, C, TEXTBOOK, TUNED = "kernel", "C -O3 -march=native", "Gymnasium + NumPy", "tuned pure Python"
SHORT = ", less work: first best action, no visits"
GOALS = {C: 0.5, TEXTBOOK: 150.0, TUNED: 15.0}
"""Least ratio of the kernel's rate to each rival's that does the same work."""
COLD, WARM, HELP = 3.0, 0.6, 0.3
"""Seconds."""
START_ROUNDS = 3
"""Starting costs seconds a time and differs little: at most this many rounds of it."""
UNIT = "Msteps/s"


ONE, SEVERAL = "8 learners, 1 thread", f"8 learners, {THREADS} threads"


def bench_kernels(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `lifelore.experiments.bench.bench`."""
    contenders = _contenders()
    check_same_bits()
    kernel_rate()  # compiled and warm before anything is timed
    starts = min(repeats, START_ROUNDS)
    total = repeats * len(contenders) + starts * (len(LEARNERS) + 1)
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
    start_rows, start_goals = _starts(starts, after)
    return {"rows": [*rate_rows, *threads, *start_rows], "goals": [*rate_goals, *start_goals]}


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


def _starts(rounds: int, after: Callable[[str], None]) -> tuple[list[dict], list[dict]]:
    """First results with a cold and a warm cache, and the command line's help."""
    rows, goals = [], []
    for learner in LEARNERS:
        times = []
        for _ in range(rounds):
            times.append(first_result_seconds(learner))
            after(f"first result of learner {learner}")
        cold, warm = (median(column) for column in zip(*times, strict=True))
        name = f"first result of learner {learner}"
        rows += [row(f"{name}, cold", cold, "s"), row(f"{name}, warm", warm, "s", f"{name}, cold", warm / cold)]
        goals += [at_most(f"{name}, cold, s", COLD, cold), at_most(f"{name}, warm, s", WARM, warm)]
    helps = []
    for _ in range(rounds):
        helps.append(help_seconds())
        after("lifelore --help")
    seconds = None if None in helps else median(helps)
    missing = "" if seconds is not None else ": not measured, no command line found"
    rows.append(row(f"lifelore --help{missing}", seconds, "s"))
    goals.append(at_most("lifelore --help, s", HELP, seconds))
    return rows, goals
