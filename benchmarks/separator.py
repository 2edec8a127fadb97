"""Time of the support vector machine between two clouds, beside scikit-learn's on the same problem.

Both get the same points, γ = 1/(2l²), C = C₀ · 4000/n (a point's cost scaled so that cost times density stays) and
tolerance, one thread each; libsvm gets a cache of 1 GB and keeps its shrinking.
"""

import time
from collections.abc import Callable
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from benchmarks.cloud_pairs import Cloud, cloud_pair, names, small_pairs
from benchmarks.process import cold_and_warm
from benchmarks.rounds import Part, at_least, at_most, counted, interleaved, joined, row, row_beside
from lifelore.core.protocols import Progress
from lifelore.perception.separation.separator import separate


class Setting(NamedTuple):
    """Length of the kernel in metres and C₀."""

    length: float
    cost: float

    def __str__(self) -> str:
        return f"l = {self.length * 1000:.0f} mm, C₀ = {self.cost:g}"


FINE, WIDE = Setting(0.06, 10.0), Setting(0.12, 1.0)
GOALS = {(FINE, 10_000): 4, (FINE, 30_000): 8, (FINE, 100_000): 10}
GOALS |= {(WIDE, 10_000): 6, (WIDE, 30_000): 9, (WIDE, 100_000): 20}
"""(setting, points) → least time of libsvm over ours."""
ROUNDS = {10_000: 100, 30_000: 5, 100_000: 1}
"""Rounds at most: libsvm takes half a minute at 100,000 points."""
EXACT_POINTS = 8000
EXACT_TOLERANCE, REFERENCE_TOLERANCE, MOST_DIFFERENCE = 1e-5, 1e-7, 1e-4
SMALL_MILLISECONDS = 4.0
COLD, WARM = 6.0, 0.5
"""Seconds to the first separator in a fresh process, imports apart."""

_FIRST = """
import time
import numpy as np
from lifelore.perception.separation.separator import separate
cloud = np.random.default_rng(0).uniform(0, 0.1, (4000, 3))
started = time.perf_counter()
found = separate(cloud, cloud + np.array([0.1013, 0, 0]))
found.decision(cloud[:1])
print(time.perf_counter() - started)
"""


def bench_separator(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    pairs, small = names(), small_pairs()
    rounds = {n: min(repeats, most) for n, most in ROUNDS.items()}
    total = sum(2 * len(pairs) * rounds[n] for _, n in GOALS) + 2 * len(pairs) + 2 * len(small) + 1
    after = counted(progress, total)
    return joined(
        _speed(pairs, rounds, after), _exactness(pairs, after), _small(small, repeats, after), _starts(after)
    )


def _speed(pairs: list[str], rounds: dict[int, int], after: Callable[[str], None]) -> Part:
    """libsvm's time over ours; the goal's number is the median over pairs."""
    rows, goals = [], []
    for (setting, n), goal in GOALS.items():
        ratios = []
        for name in pairs:
            first, second = cloud_pair(name, n)
            cost = setting.cost * 4000 / n
            label = f"{name}, n = {n}, {setting}"
            ours, theirs = f"ours: {label}", f"libsvm: {label}"
            _ours(first[:500], second[:500], setting.length, cost)  # compiled before it is timed
            times = interleaved(
                {
                    ours: lambda a=first, b=second, c=cost, s=setting: _ours(a, b, s.length, c),
                    theirs: lambda a=first, b=second, c=cost, s=setting: _theirs(a, b, s.length, c),
                },
                rounds[n],
                after,
            )
            rows += [row_beside(ours, times, "ms"), row_beside(theirs, times, "ms", ours)]
            ratios.append(rows[-1]["ratio"])
        goals.append(at_least(f"libsvm / ours, n = {n}, {setting}", goal, median(ratios)))
    return rows, goals


def _exactness(pairs: list[str], after: Callable[[str], None]) -> Part:
    """Support vectors that differ from those of a much tighter libsvm, and the decision's greatest difference."""
    rows, goals, differing, difference = [], [], 0, 0.0
    for name in pairs:
        first, second = cloud_pair(name, EXACT_POINTS)
        for setting in (FINE, WIDE):
            cost = setting.cost * 4000 / EXACT_POINTS
            found = separate(first, second, length=setting.length, cost=cost, tolerance=EXACT_TOLERANCE)
            reference = _libsvm(first, second, setting.length, cost, REFERENCE_TOLERANCE)
            points = np.concatenate([first, second])
            away = float(np.abs(found.decision(points) - reference.decision_function(points)).max())
            support = np.concatenate([found.support_first, found.support_second + len(first)])
            apart = len(np.setxor1d(support, reference.support_))
            label = f"{name}, n = {EXACT_POINTS}, {setting}"
            rows.append(row(f"support vectors that differ: {label}", apart, f"of {len(support)}"))
            rows.append(row(f"greatest difference of f: {label}", away, ""))
            differing, difference = max(differing, apart), max(difference, away)
            after(f"exactness: {label}")
    goals.append(at_most("support vectors that differ at tolerance 1e-5", 0, differing))
    goals.append(at_most("greatest difference of f at tolerance 1e-5", MOST_DIFFERENCE, difference))
    return rows, goals


def _small(pairs: dict[str, tuple[Cloud, Cloud]], repeats: int, after: Callable[[str], None]) -> Part:
    """Milliseconds a pair of 3 mm voxels takes; the goal is for the median pair. C is not scaled."""
    rows, goals = [], []
    for setting in (FINE, WIDE):
        medians = []
        for name, (first, second) in pairs.items():
            times = [_ours(first, second, setting.length, setting.cost) for _ in range(repeats)]
            medians.append(median(times))
            label = f"{name}, {len(first) + len(second)} voxels of 3 mm, {setting}"
            rows.append(row(f"ours: {label}", medians[-1], "ms"))
            after(f"small pairs: {label}")
        goals.append(at_most(f"3 mm voxels, {setting}, ms", SMALL_MILLISECONDS, median(medians)))
    return rows, goals


def _starts(after: Callable[[str], None]) -> Part:
    cold, warm = cold_and_warm(_FIRST)
    after("first separator")
    name = "first separator in a fresh process"
    rows = [row(f"{name}, cold", cold, "s"), row(f"{name}, warm", warm, "s", f"{name}, cold", warm / cold)]
    return rows, [at_most(f"{name}, cold, s", COLD, cold), at_most(f"{name}, warm, s", WARM, warm)]


def _ours(first: Cloud, second: Cloud, length: float, cost: float) -> float:
    """Milliseconds of our separator."""
    started = time.perf_counter()
    separate(first, second, length=length, cost=cost)
    return 1e3 * (time.perf_counter() - started)


def _theirs(first: Cloud, second: Cloud, length: float, cost: float) -> float:
    """Milliseconds of scikit-learn's."""
    started = time.perf_counter()
    _libsvm(first, second, length, cost, 1e-3)
    return 1e3 * (time.perf_counter() - started)


def _libsvm(first: Cloud, second: Cloud, length: float, cost: float, tolerance: float):
    from sklearn.svm import SVC

    points = np.concatenate([first, second])
    side = np.repeat([1.0, -1.0], [len(first), len(second)])
    gamma: Any = 1 / (2 * length**2)  # the stub knows words alone
    return SVC(C=cost, gamma=gamma, tol=tolerance, cache_size=1000).fit(points, side)
