"""Solution of the separator's dual by working sets: optimise over few points, evaluate all, choose anew."""

import numpy as np

from lifelore.perception.separation.gaussian import Array
from lifelore.perception.separation.separator_dual import Dual, Indices
from lifelore.perception.separation.separator_smo import ascend

FIRST_WORKING = 500
"""Largest number of points of each cloud in the first working set; fewer need more working sets."""
MOST_WORKING = 2000
"""Largest working set in points: its memory is 8 bytes times its square."""
MOST_ROUNDS = 100
"""Largest number of working sets; more cost time, not accuracy."""
BAND = 0.25
"""Points within this share of the violation from violating join the working set beforehand."""


def descend(dual: Dual, tolerance: float, max_steps: int) -> float:
    """Solve a dual in place, from an even subset of its points on; returns the violation.

    Parameters
    ----------
    dual : Dual
    tolerance : float
        Violation at which to stop.
    max_steps : int
        Optimiser steps after which to stop. Where the dual's work runs out before, the returned violation is a
        bound, infinite where it was never evaluated.
    """
    working = _thinned(dual.side)
    if dual.affords(len(working)):
        *_, steps = _step(dual, working, tolerance, max_steps)
        max_steps -= steps
    dual.evaluate()
    for _ in range(MOST_ROUNDS):
        most, least = dual.extremes(tolerance)
        if most - least <= tolerance or max_steps <= 0 or dual.spent:
            break
        working = _working_set(dual, most, least)
        if not dual.affords(len(working)):
            break
        changed, before, steps = _step(dual, working, tolerance, max_steps)
        max_steps -= steps
        slope = dual.slope[working]
        dual.pull(changed, dual.beta[changed] - before)
        dual.slope[working], dual.error[working] = slope, 0.0
    most, least = dual.extremes(np.inf)
    return max(most - least, 0.0)


def _step(dual: Dual, working: Indices, tolerance: float, max_steps: int) -> tuple[Indices, Array, int]:
    """Optimise over `working` alone; the points that changed, their β before, and the steps taken."""
    dual.settle(working)
    points = np.ascontiguousarray(dual.points[:, working])
    beta, slope = dual.beta[working], dual.slope[working]
    limit = int(min(dual.steps_left(len(working)), max_steps))
    steps = ascend(points, dual.lower[working], dual.upper[working], beta, slope, tolerance / 2, limit)
    dual.count_steps(steps, len(working))
    before = dual.beta[working]
    changed = beta != before
    dual.beta[working], dual.slope[working] = beta, slope
    return working[changed], before[changed], steps


def _working_set(dual: Dual, most: float, least: float) -> Indices:
    """Free points, violators and near violators, ascending; the worst of either end if there are too many."""
    free = dual.free()
    bias = float(dual.slope[free].mean()) if len(free) else (most + least) / 2
    over = np.where(dual.beta < dual.upper, dual.slope - bias, -np.inf)
    under = np.where(dual.beta > dual.lower, bias - dual.slope, -np.inf)
    excess = np.maximum(over, under) + dual.error + BAND * (most - least)
    excess[free] = np.inf
    chosen = np.flatnonzero(excess > 0)
    if len(chosen) <= MOST_WORKING:
        return chosen
    half = MOST_WORKING // 2
    over = np.argsort(np.where(dual.beta < dual.upper, -dual.slope, np.inf)[chosen], kind="stable")[:half]
    under = np.argsort(np.where(dual.beta > dual.lower, dual.slope, np.inf)[chosen], kind="stable")[:half]
    return chosen[np.union1d(over, under)]


def _thinned(side: Array) -> Indices:
    """All points, or an even subset of each side."""
    parts = [np.flatnonzero(side == sign) for sign in (1, -1)]
    sizes = [min(len(part), FIRST_WORKING) for part in parts]
    return np.concatenate(
        [
            part[np.linspace(0, len(part) - 1, size).astype(np.int64)]
            for part, size in zip(parts, sizes, strict=True)
        ]
    )
