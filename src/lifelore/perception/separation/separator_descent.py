"""Solution of the separator's dual by working sets: optimise over few points, evaluate all, choose anew."""

import numpy as np

from lifelore.perception.separation.gaussian import Array
from lifelore.perception.separation.separator_dual import Dual, Indices
from lifelore.perception.separation.separator_smo import ascend

FIRST_WORKING = 500
"""Largest number of points of each cloud in the first working set; fewer need more working sets."""
MOST_WORKING = 2000
"""Largest working set in points: its memory is 8 bytes times its square."""
MOST_STEPS = 500_000
"""Largest number of steps over a working set, some seconds; soft margins need hundreds to thousands."""
MOST_ROUNDS = 100
"""Largest number of working sets; more cost time, not accuracy."""
BAND = 0.25
"""Points within this share of the violation from violating join the working set beforehand."""


def descend(dual: Dual, tolerance: float) -> float:
    """Solve a dual in place, from an even subset of its points on; returns the violation.

    Parameters
    ----------
    dual : Dual
    tolerance : float
        Violation at which to stop. Where the dual's work runs out before, the returned violation is a bound,
        infinite where it was never evaluated.
    """
    working = np.concatenate([_even(np.flatnonzero(dual.side == sign), FIRST_WORKING) for sign in (1, -1)])
    if dual.affords(len(working)):
        _step(dual, working, tolerance)
    dual.evaluate()
    for _ in range(MOST_ROUNDS):
        most, least = dual.extremes(tolerance)
        if most - least <= tolerance or dual.spent:
            break
        working = _working_set(dual, most, least, tolerance)
        if not dual.affords(len(working)):
            break
        changed, before = _step(dual, working, tolerance)
        slope = dual.slope[working]
        dual.pull(changed, dual.beta[changed] - before)
        dual.slope[working], dual.error[working] = slope, 0.0
    most, least = dual.extremes(np.inf)
    return max(most - least, 0.0)


def _step(dual: Dual, working: Indices, tolerance: float) -> tuple[Indices, Array]:
    """Optimise over `working` alone; the points that changed, and their β before."""
    dual.settle(working)
    points = np.ascontiguousarray(dual.points[:, working])
    beta, slope = dual.beta[working], dual.slope[working]
    limit = int(min(dual.steps_left(len(working)), MOST_STEPS))
    steps = ascend(points, dual.lower[working], dual.upper[working], beta, slope, tolerance / 2, limit)
    dual.count_steps(steps, len(working))
    before = dual.beta[working]
    changed = beta != before
    dual.beta[working], dual.slope[working] = beta, slope
    return working[changed], before[changed]


def _working_set(dual: Dual, most: float, least: float, tolerance: float) -> Indices:
    """Free points, violators and near violators; of too many, an even subset with the worst of either end.

    The points are sorted by place, so that an even subset violates all along the surface. The worst points lie
    close together, and would be the next set's worst again.
    """
    free = dual.free()
    bias = float(dual.slope[free].mean()) if len(free) else (most + least) / 2
    over = np.where(dual.beta < dual.upper, dual.slope - bias, -np.inf)
    under = np.where(dual.beta > dual.lower, bias - dual.slope, -np.inf)
    excess = np.maximum(over, under) + dual.error
    near = excess + BAND * (most - least) > 0
    near[free] = True
    if np.count_nonzero(near) <= MOST_WORKING:
        return np.flatnonzero(near)
    violators, ends = np.flatnonzero(excess > tolerance / 2), [over.argmax(), under.argmax()]
    return np.union1d(ends, np.concatenate([_even(free, MOST_WORKING // 2), _even(violators, MOST_WORKING // 2)]))


def _even(points: Indices, size: int) -> Indices:
    """At most `size` of the points, evenly spaced in order."""
    return points[np.linspace(0, len(points) - 1, min(len(points), size)).astype(np.int64)]
