"""Coarse-to-fine solution of the separator's dual: each level starts from the coarser solution and uses working
sets."""

import numpy as np

from lifelore.perception.separation.far_field import WIDEST, Cells, far_field_cells
from lifelore.perception.separation.gaussian import Array
from lifelore.perception.separation.nested_voxels import Level, VoxelPyramid
from lifelore.perception.separation.separator_dual import Dual, Indices
from lifelore.perception.separation.separator_smo import ascend

MOST_WORKING = 2000
"""Largest working set in points: its memory is 8 bytes times its square."""
MOST_ROUNDS = 100
"""Largest number of working sets per level; more cost time, not accuracy."""
COARSE_TOLERANCE = 1e-2
"""Violation allowed on a coarse level: the step to the next level loses more precision."""
BAND = 0.25
"""Points within this share of the violation from violating join the working set beforehand."""
STEEP = 8.0
"""Assumed bound on the change of f per kernel length, when a level's members are selected."""
GUESS_BAND = 0.1
"""Assumed difference of f between two levels, for the first working set. Results depend on neither bound."""


def descend(
    nested: VoxelPyramid, tolerance: float, max_steps: int, max_work: float = np.inf
) -> tuple[Dual, float]:
    """Solve all levels, coarsest first; returns the points' dual and its violation.

    Parameters
    ----------
    nested : Nested
    tolerance : float
        Violation at which to stop.
    max_steps : int
        Optimiser steps over all levels, after which to stop.
    max_work : float
        Evaluations of a Gaussian after which to stop: each coarser voxel's weight is then divided evenly among its
        points, and the reported violation is a bound, infinite where it was never evaluated.
    """
    dual, violation = None, np.inf
    for level in nested.levels:
        last = level is nested.levels[-1]
        bound = tolerance if last else max(tolerance, COARSE_TOLERANCE)
        if dual is None:
            dual, working = Dual(level, np.zeros(len(level.side)), max_work=max_work), _thinned(level.side)
        else:
            dual, working = _refined(dual, level, last)
        if last:
            dual.cells = _cells(level, nested.cell_starts)
        violation, max_steps = _optimise(dual, working, bound, max_steps)
    assert dual is not None
    return dual, violation


def _cells(level: Level, starts: Indices) -> Cells | None:
    cells = far_field_cells(level.points, starts)
    return cells if cells.radius.max() <= WIDEST else None


def _optimise(dual: Dual, working: Indices, tolerance: float, max_steps: int) -> tuple[float, int]:
    """Optimise over working sets, starting with `working`; returns the violation and the remaining steps."""
    if len(working) and dual.affords(len(working)):
        changed, before, steps = _step(dual, working, tolerance, max_steps)
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
    return max(most - least, 0.0), max_steps


def _step(dual: Dual, working: Indices, tolerance: float, max_steps: int) -> tuple[Indices, Array, int]:
    """Optimise over `working` alone; the points that changed, their β before, and the steps taken."""
    dual.settle(working)
    points = np.ascontiguousarray(dual.level.points[:, working])
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
    chosen = _violating(dual, bias, dual.error + BAND * (most - least))
    if len(chosen) <= MOST_WORKING:
        return chosen
    half = MOST_WORKING // 2
    over = np.argsort(np.where(dual.beta < dual.upper, -dual.slope, np.inf)[chosen], kind="stable")[:half]
    under = np.argsort(np.where(dual.beta > dual.lower, dual.slope, np.inf)[chosen], kind="stable")[:half]
    return chosen[np.union1d(over, under)]


def _violating(dual: Dual, bias: float, band: Array | float) -> Indices:
    """Free points and those that violate by more than -band."""
    over = np.where(dual.beta < dual.upper, dual.slope - bias, -np.inf)
    under = np.where(dual.beta > dual.lower, bias - dual.slope, -np.inf)
    excess = np.maximum(over, under) + band
    excess[dual.free()] = np.inf
    return np.flatnonzero(excess > 0)


def _thinned(side: Array) -> Indices:
    """All points, or an even subset of each side."""
    parts = [np.flatnonzero(side == sign) for sign in (1, -1)]
    most = MOST_WORKING // 2
    return np.concatenate([p[np.linspace(0, len(p) - 1, min(len(p), most)).astype(np.int64)] for p in parts])


def _refined(coarse: Dual, level: Level, last: bool) -> tuple[Dual, Indices]:
    """The next level's dual with the coarse level's weights, and its first working set.

    A free voxel's weight goes to its members deepest in the margin, up to their caps.
    """
    starts, bias = coarse.level.starts, coarse.bias()
    counts = np.diff(starts)
    near = np.abs(coarse.slope - bias) < STEEP * coarse.level.edge
    near[coarse.free()] = True
    members = np.flatnonzero(np.repeat(near, counts))
    if coarse.spent or not coarse.affords(len(members)):
        return _shared_out(coarse, level), members[:0]
    sums = coarse.sums(np.ascontiguousarray(level.points[:, members]))
    beta = np.where(np.repeat(coarse.beta == 0, counts), 0.0, level.side * level.cap)
    _fill(coarse, level, members, sums, beta)
    dual = Dual(level, beta, None if last else members, work=coarse.work, max_work=coarse.max_work)
    dual.slope[:] = np.repeat(coarse.slope, counts)
    dual.slope[members] = level.side[members] - sums
    working = _violating(dual, bias, GUESS_BAND)
    if not last:
        dual.error[np.repeat(~near, counts)] = 0.0
    return dual, working


def _shared_out(coarse: Dual, level: Level) -> Dual:
    """The next level's dual with each voxel's weight over its members, evenly by their caps; all work spent."""
    counts = np.diff(coarse.level.starts)
    share = np.abs(coarse.beta) / coarse.level.cap
    beta = level.side * level.cap * np.minimum(np.repeat(share, counts), 1.0)
    dual = Dual(level, beta, work=coarse.max_work, max_work=coarse.max_work)
    dual.slope[:] = np.repeat(coarse.slope, counts)
    return dual


def _fill(coarse: Dual, level: Level, members: Indices, sums: Array, beta: Array) -> None:
    """Hand each free voxel's weight to its members, smallest y f first, up to their caps."""
    starts = coarse.level.starts
    voxel = np.repeat(np.arange(len(starts) - 1), np.diff(starts))[members]
    mine = np.isin(voxel, coarse.free())
    members, voxel, depth = members[mine], voxel[mine], (level.side[members] * sums)[mine]
    order = np.lexsort((depth, voxel))
    members = members[order]  # still voxel by voxel
    filled = np.cumsum(level.cap[members])
    begins = np.flatnonzero(np.diff(voxel, prepend=-1))
    above = np.append(0.0, filled)[begins]
    filled -= np.repeat(above, np.diff(begins, append=len(voxel)))
    before = filled - level.cap[members]
    weight = np.abs(coarse.beta)[voxel]
    beta[members] = level.side[members] * np.clip(weight - before, 0.0, level.cap[members])
