"""Steps of Q-learning a second: the kernel beside C, a textbook loop and tuned Python.

Everyone does the same work unless the name of the row says otherwise.
"""

from collections.abc import Callable

from benchmarks.lattice import kernel_rate
from benchmarks.peers.c_loop import built_c_loop
from benchmarks.peers.gymnasium_loop import short_textbook_rate, textbook_rate
from benchmarks.peers.list_loop import short_tuned_rate, tuned_rate
from benchmarks.rounds import Part, Rates, at_least, counted, interleaved, joined, paired_ratio, row, row_beside
from lifelore.core.protocols import Progress

KERNEL, C, TEXTBOOK, TUNED = "kernel", "C -O3 -march=native", "Gymnasium + NumPy", "tuned pure Python"
SHORT = ", less work: first best action, no visits"
GOALS = {C: 0.75, TEXTBOOK: 150.0, TUNED: 15.0}
"""Least ratio of the kernel's rate to each rival's that does the same work."""
UNIT = "Msteps/s"


def bench_kernels(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    contenders = _contenders()
    kernel_rate()  # compiled and warm before anything is timed
    after = counted(progress, repeats * len(contenders))
    return joined(_beside(interleaved(contenders, repeats, after)))


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
