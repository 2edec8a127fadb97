"""The soft-margin support vector machine between two clouds, exact, with a Gaussian kernel.

    f(x) = Σ y_i α_i k(x_i, x) + b,    k(x, z) = exp(-|x - z|² / 2l²),    0 ≤ α_i ≤ C

Support vectors lie where the clouds face one another; contact points are clusters of them. The problem is
scikit-learn's (libsvm), solved 4 to 13 times as fast at 10,000 points and 46 to 67 times at 100,000.
Thesis: §2.3.4, with a soft margin instead of its hard one.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.perception.separation.far_field import cell_order, far_field_cells
from lifelore.perception.separation.gaussian import Array, kernel_sums
from lifelore.perception.separation.separator_descent import descend
from lifelore.perception.separation.separator_dual import Dual

MOST_WORK = 3e9
"""Largest number of evaluations of a Gaussian, four seconds."""
_FURTHEST = 1e12
"""Largest distance in kernel lengths; beyond it squares lose the distances between neighbours."""


@dataclass(frozen=True, eq=False)
class Separator:
    """The separating surface of two clouds and its support vectors.

    Parameters
    ----------
    points_first, points_second : (k₁, 3), (k₂, 3) float64
        The support vectors of either cloud, metres.
    support_first, support_second : (k₁,), (k₂,) int64
        Their indices in the clouds, ascending.
    alpha_first, alpha_second : (k₁,), (k₂,) float64
        Multipliers, 0 < α ≤ cost; both sum to the same.
    bias : float
        b of the decision function.
    length : float
        The kernel's length l, metres.
    max_violation : float
        Largest violation of the optimality (Karush-Kuhn-Tucker) conditions over all points, ≥ 0. Where `max_work`
        ran out, an upper bound; infinite where it was never evaluated.
    """

    points_first: Array
    points_second: Array
    support_first: NDArray[np.int64]
    support_second: NDArray[np.int64]
    alpha_first: Array
    alpha_second: Array
    bias: float
    length: float
    max_violation: float

    def decision(self, points: ArrayLike) -> Array:
        """f at `points` (m, 3), metres: positive on the side of the first cloud, (m,)."""
        points = np.asarray(points, float).reshape(-1, 3)
        sources, weights = self._sources()
        sums = np.empty(len(points))
        scaled = [np.ascontiguousarray((cloud - sources[0]).T / self.length) for cloud in (points, sources)]
        kernel_sums(scaled[0], scaled[1], weights, np.arange(len(points)), sums)
        return sums + self.bias

    def gradient(self, points: ArrayLike) -> Array:
        """∇f at `points` (m, 3), 1/m: towards the first cloud, (m, 3)."""
        points = np.asarray(points, float).reshape(-1, 3)
        sources, weights = self._sources()
        slopes = np.empty_like(points)
        for i, point in enumerate(points):
            away = (sources - point) / self.length
            pulls = weights * np.exp(-0.5 * np.einsum("ij,ij->i", away, away))
            slopes[i] = pulls @ away / self.length
        return slopes

    def _sources(self) -> tuple[Array, Array]:
        return (
            np.concatenate([self.points_first, self.points_second]),
            np.concatenate([self.alpha_first, -self.alpha_second]),
        )


def separate(
    first: ArrayLike,
    second: ArrayLike,
    *,
    length: float = 0.12,
    cost: float = 1.0,
    tolerance: float = 1e-3,
    max_work: float = MOST_WORK,
) -> Separator:
    """Separate two clouds by the soft-margin support vector machine of a Gaussian kernel.

    Parameters
    ----------
    first, second : (n₁, 3), (n₂, 3) float
        The clouds, metres.
    length : float
        The kernel's length, metres, > 0.
    cost : float
        C, the largest weight of a point, > 0.
    tolerance : float
        Greatest violation of the optimality conditions, > 0; 1e-3 is libsvm's default.
    max_work : float
        Kernel evaluations after which to stop, > 0; the violation is reported. Clouds that lie *in* each other
        have no surface between them and would take minutes.

    Raises
    ------
    InputError
        A cloud is empty or not finite or not (n, 3), or a parameter is not positive.

    Examples
    --------
    >>> import numpy as np
    >>> plate = np.stack(np.meshgrid(np.arange(20), np.arange(20), 0), axis=-1).reshape(-1, 3) * 0.005
    >>> between = separate(plate + [0, 0, 0.01], plate, length=0.06, cost=10.0)
    >>> bool(between.max_violation <= 1e-3)
    True
    >>> between.gradient([[0.05, 0.05, 0.005]])[0].argmax()  # up, out of the lower plate
    np.int64(2)
    """
    a, b = checked_points("first", first), checked_points("second", second)
    for name, value in (("length", length), ("cost", cost), ("tolerance", tolerance)):
        if not (np.isfinite(value) and value > 0):
            raise InputError(f"{name} must be positive and finite, got {value}")
    if not max_work > 0:
        raise InputError(f"max_work must be above 0, got {max_work}")
    points = np.concatenate([a, b])
    n, n_first = len(points), len(a)
    side = np.where(np.arange(n) < n_first, 1.0, -1.0)
    scaled = _scaled(points, length)
    order, starts = cell_order(scaled)
    scaled = np.ascontiguousarray(scaled[:, order])
    dual = Dual(scaled, side[order], far_field_cells(scaled, starts), cost, max_work)
    violation = descend(dual, tolerance)
    beta = np.empty(n)
    beta[order] = dual.beta
    support = np.flatnonzero(beta)
    one, two = support[support < n_first], support[support >= n_first]
    return Separator(
        points[one], points[two], one, two - n_first, beta[one], -beta[two], dual.bias(), length, violation
    )


def _scaled(points: Array, length: float) -> Array:
    """The points in lengths of the kernel about their first one, (3, n)."""
    scaled = np.ascontiguousarray((points - points[0]).T / length)
    if not np.abs(scaled).max() < _FURTHEST:
        raise InputError(
            f"the clouds must lie within {_FURTHEST:g} lengths of the kernel ({length} m) of each other; "
            "give both in metres and in one frame"
        )
    return scaled


def checked_points(name: str, cloud: ArrayLike) -> Array:
    """The argument `name` as a finite (n, 3) float64 array, n ≥ 1; raises InputError for anything else."""
    try:
        cloud = np.asarray(cloud, float)
    except (TypeError, ValueError):
        raise InputError(
            f"{name} must be a cloud of shape (n, 3), got rows of different lengths or no numbers"
        ) from None
    if cloud.ndim != 2 or cloud.shape[1] != 3 or len(cloud) == 0:
        raise InputError(f"{name} must be a cloud of shape (n, 3) with n ≥ 1, got shape {cloud.shape}")
    if not np.isfinite(cloud).all():
        raise InputError(f"{name} must be finite, got NaN or infinite coordinates; drop those points first")
    return cloud
