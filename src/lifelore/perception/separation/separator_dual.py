"""The dual of a separator: multipliers, and slopes that are exact or within a known error.

Notation as in `separator_smo`: β = yα, slope r = y - Kβ. Slopes of a working set, extremes and the bias are
evaluated exactly before they are used.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.perception.separation.far_field import Cells, far_field
from lifelore.perception.separation.gaussian import Array, kernel_sums

ORDER = 5
"""Degree of the far field's expansions."""
_PER_CELL, _PER_POINT = 24, 25
"""An expansion's cost for each cell and source, and for each point, in evaluations of one Gaussian."""
_PER_STEP = 2
"""An optimiser's step's cost for each point of its working set, likewise; besides, it needs two kernel rows."""

Indices = NDArray[np.int64]


@dataclass(eq=False)
class Dual:
    """The dual, changed in place.

    Parameters
    ----------
    points : (3, n) float64
        In lengths of the kernel, sorted by cell.
    side : (n,) float64
        +1 for the first cloud, -1 for the second.
    cells : Cells
        Far-field cells of the points.
    cost : float
        Greatest |β| of a point.
    max_work : float
        Limit of `work`. At the limit slopes are no longer evaluated and stay within their errors.

    Attributes
    ----------
    work : float
        Evaluations of a Gaussian so far.
    beta : (n,) float64
        Σβ = 0 and lower ≤ β ≤ upper; zeros at first.
    lower, upper : (n,) float64
        0 and the cost for the first cloud, minus the cost and 0 for the second.
    slope, error : (n,) float64
        |slope - exact slope| ≤ error; infinite until `evaluate` or `settle`.
    """

    points: Array
    side: Array
    cells: Cells
    cost: float
    max_work: float = np.inf
    work: float = field(init=False, default=0.0)
    beta: Array = field(init=False)
    lower: Array = field(init=False)
    upper: Array = field(init=False)
    slope: Array = field(init=False)
    error: Array = field(init=False)

    def __post_init__(self) -> None:
        bound = self.side * self.cost
        self.beta = np.zeros(len(bound))
        self.lower, self.upper = np.minimum(bound, 0.0), np.maximum(bound, 0.0)
        self.slope, self.error = self.side.copy(), np.full(len(bound), np.inf)

    @property
    def spent(self) -> bool:
        """Whether no work is left."""
        return self.work >= self.max_work

    def affords(self, n_points: int) -> bool:
        """Whether the remaining work allows the sums of all support vectors at `n_points` points."""
        return self.work + n_points * float(np.count_nonzero(self.beta)) <= self.max_work

    def steps_left(self, n_points: int) -> float:
        """Steps over `n_points` points that half of the remaining work allows; the rest updates the slopes."""
        each = (self.max_work - self.work) / (2 * n_points)
        return max(each / (_PER_STEP + 2), (each - n_points) / _PER_STEP, 1.0)

    def count_steps(self, n_steps: int, n_points: int) -> None:
        """Add the work of `n_steps` steps over `n_points` points; no kernel row is computed twice."""
        self.work += (_PER_STEP * n_steps + min(2 * n_steps, n_points)) * n_points

    def evaluate(self) -> None:
        """Compute all slopes; exact slopes stay. Does nothing if too little work remains."""
        support = np.flatnonzero(self.beta)
        if self.work + self._cost(len(support)) > self.max_work:
            self.work = max(self.work, self.max_work)
            return
        exact = self.error == 0
        exact_slopes = self.slope[exact]
        self.slope[:], self.error[:] = self.side, 0.0
        self.pull(support, self.beta[support])
        self.slope[exact], self.error[exact] = exact_slopes, 0.0

    def pull(self, which: Indices, weights: Array) -> None:
        """Subtract from all slopes the sums of Gaussians at the points `which` with `weights`."""
        n, k = len(self.side), len(which)
        if k == 0:
            return
        self.work += self._cost(k)
        sources, sums = np.ascontiguousarray(self.points[:, which]), np.zeros(n)
        if self._far_cost(k) < n * k:
            sums, error = far_field(self.points, self.cells, sources, weights, ORDER)
            self.error += error
        else:
            kernel_sums(self.points, sources, weights, np.arange(n), sums)
        self.slope -= sums

    def _far_cost(self, n_sources: int) -> float:
        return len(self.cells.radius) * n_sources * _PER_CELL + len(self.side) * _PER_POINT

    def _cost(self, n_sources: int) -> float:
        """Work of the sums of `n_sources` sources at all points."""
        return min(self._far_cost(n_sources), len(self.side) * n_sources)

    def settle(self, which: Indices) -> None:
        """Evaluate the slopes of `which` exactly, where work remains."""
        which = which[self.error[which] > 0]
        if len(which) and not self.affords(len(which)):
            self.work = max(self.work, self.max_work)
        elif len(which):
            support, sums = np.flatnonzero(self.beta), np.empty(len(self.side))
            self.work += len(support) * len(which)
            kernel_sums(
                self.points, np.ascontiguousarray(self.points[:, support]), self.beta[support], which, sums
            )
            self.slope[which] = self.side[which] - sums[which]
            self.error[which] = 0.0

    def extremes(self, tolerance: float) -> tuple[float, float]:
        """max{r : β < upper} and min{r : β > lower}: exact if within `tolerance`, else possibly too close.

        Without remaining work: as far apart as the errors allow.
        """
        if not self.spent:
            most, least = _ends(self.beta, self.lower, self.upper, self.slope, self.error, -1.0)
            if most - least > tolerance:
                return most, least
            if self.error.any():
                rising, falling = self.beta < self.upper, self.beta > self.lower
                self.settle(np.flatnonzero(rising & (self.slope + self.error >= most)))
                self.settle(np.flatnonzero(falling & (self.slope - self.error <= least)))
        return _ends(self.beta, self.lower, self.upper, self.slope, self.error, 1.0 if self.spent else 0.0)

    def free(self) -> Indices:
        """The points strictly between their bounds."""
        return np.flatnonzero((self.beta > self.lower) & (self.beta < self.upper))

    def bias(self) -> float:
        """The mean slope of free points, equal at an optimum; without any, the middle of the extremes."""
        free = self.free()
        if len(free):
            self.settle(free)
            return float(self.slope[free].mean())
        most, least = self.extremes(np.inf)
        return (most + least) / 2 if np.isfinite(most - least) else float(np.median(self.slope))


@kernel
def _ends(beta, lower, upper, slope, error, errors):
    """max{r : β < upper} and min{r : β > lower}, farther apart by `errors` times the error of each slope.

    Since Σβ = 0, both sets hold a point.
    """
    most, least = -np.inf, np.inf
    for i in range(len(beta)):
        wider = errors * error[i] if errors != 0.0 else 0.0
        if beta[i] < upper[i]:
            most = max(most, slope[i] + wider)
        if beta[i] > lower[i]:
            least = min(least, slope[i] - wider)
    return most, least
