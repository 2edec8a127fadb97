"""The dual of one level, kept up to date: multipliers, and slopes that are exact or known within a bound.

Notation as in `separator_smo`: β = yα, slope r = y - Kβ. Whatever a decision hangs on (the slopes of a working
set, the extremes, the bias) is evaluated exactly first.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.far_field import Cells, far_field
from lifelore.perception.gaussian import Array, kernel_sums
from lifelore.perception.nested_voxels import Level

ORDER = 5
"""Degree of the far field's expansions."""
_PER_CELL, _PER_POINT = 24, 25
"""An expansion's cost for each cell and source, and for each point, in evaluations of one Gaussian."""

Indices = NDArray[np.int64]


@dataclass(eq=False)
class Dual:
    """One level's dual, changed in place.

    Parameters
    ----------
    level : Level
    beta : (m,) float64
        Σβ = 0 and lower ≤ β ≤ upper.
    scope : (k,) int64 or None
        The points that are looked at, ascending; the others keep the slope they are given. None: all.
    cells : Cells or None
        Far-field cells of the level's points, if all are looked at; None: every sum is exact.

    Attributes
    ----------
    lower, upper : (m,) float64
        0 and the cap for the first cloud, minus the cap and 0 for the second.
    slope, error : (m,) float64
        |slope - exact slope| ≤ error; infinite until `evaluate` or `settle`.
    """

    level: Level
    beta: Array
    scope: Indices | None = None
    cells: Cells | None = None
    lower: Array = field(init=False)
    upper: Array = field(init=False)
    slope: Array = field(init=False)
    error: Array = field(init=False)

    def __post_init__(self) -> None:
        bound = self.level.side * self.level.cap
        self.lower, self.upper = np.minimum(bound, 0.0), np.maximum(bound, 0.0)
        self.slope, self.error = self.level.side.copy(), np.full(len(bound), np.inf)

    def evaluate(self) -> None:
        """All slopes from all multipliers; those already exact stay so."""
        exact = self.error == 0
        kept = self.slope[exact]
        scope = slice(None) if self.scope is None else self.scope
        self.slope[scope], self.error[scope] = self.level.side[scope], 0.0
        support = np.flatnonzero(self.beta)
        self.pull(support, self.beta[support])
        self.slope[exact], self.error[exact] = kept, 0.0

    def pull(self, which: Indices, weights: Array) -> None:
        """Take the sums of Gaussians of `weights` at the points `which` off all slopes."""
        points = self.level.points
        n, k = points.shape[1], len(which)
        if k == 0:
            return
        sources, sums = np.ascontiguousarray(points[:, which]), np.zeros(n)
        if self.cells is not None and len(self.cells.radius) * k * _PER_CELL + n * _PER_POINT < n * k:
            sums, error = far_field(points, self.cells, sources, weights, ORDER)
            self.error += error
        else:
            kernel_sums(points, sources, weights, np.arange(n) if self.scope is None else self.scope, sums)
        self.slope -= sums

    def settle(self, which: Indices) -> None:
        """Evaluate the slopes of `which` exactly, where they are not."""
        which = which[self.error[which] > 0]
        if len(which):
            sums = self.sums(np.ascontiguousarray(self.level.points[:, which]))
            self.slope[which] = self.level.side[which] - sums
            self.error[which] = 0.0

    def sums(self, points: Array) -> Array:
        """Σ_j β_j k(point, x_j) at `points` (3, m), exactly."""
        support = np.flatnonzero(self.beta)
        sources, out = np.ascontiguousarray(self.level.points[:, support]), np.empty(points.shape[1])
        kernel_sums(points, sources, self.beta[support], np.arange(points.shape[1]), out)
        return out

    def extremes(self, tolerance: float) -> tuple[float, float]:
        """max{r : β < upper} and min{r : β > lower}: exact if within `tolerance`, else possibly too close."""
        rising, falling = np.flatnonzero(self.beta < self.upper), np.flatnonzero(self.beta > self.lower)
        if len(rising) == 0 or len(falling) == 0:
            return 0.0, 0.0
        most = float((self.slope[rising] - self.error[rising]).max())
        least = float((self.slope[falling] + self.error[falling]).min())
        if most - least > tolerance:
            return most, least
        self.settle(rising[self.slope[rising] + self.error[rising] >= most])
        self.settle(falling[self.slope[falling] - self.error[falling] <= least])
        return float(self.slope[rising].max()), float(self.slope[falling].min())

    def free(self) -> Indices:
        """The points strictly between their bounds."""
        return np.flatnonzero((self.beta > self.lower) & (self.beta < self.upper))

    def bias(self) -> float:
        """The mean slope of free points, which at an optimum all have the same; without any, the middle."""
        free = self.free()
        if len(free):
            self.settle(free)
            return float(self.slope[free].mean())
        most, least = self.extremes(np.inf)
        return (most + least) / 2
