"""An estimate from logged decisions, with a 95 % interval clustered by user.

Outcomes of a user depend on one another, so the user is the unit: an estimate is linearised into one contribution
φ_u a user, and

    variance = G / (G − 1) Σ_u φ_u²                    of G users
    interval = value ± t_{0.975, f} √variance          f = 2 / (Σ φ⁴ / (Σ φ²)² − 1 / G), at least 1, at most G − 1

f is Satterthwaite's number of degrees of freedom from the spread of φ²: G where φ is normal, few where a few users
with large weights or rare outcomes decide the estimate.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.intervals import LEAST_VALUES, t_interval

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ClusteredEstimate:
    """A value, its uncertainty, and each user's contribution.

    Parameters
    ----------
    value, standard_error : float
    ci95 : (low, high) or None
        None below `LEAST_VALUES` users, or where the contributions have no spread.
    n_decisions, n_users : int
    influence : (n_users,) float64
        φ of each user, in the order of the sorted users; sums to 0.

    Examples
    --------
    >>> from lifelore.interaction.evaluation import logged_value
    >>> found = logged_value([1.0, 0.0, 1.0, 1.0], ["ann", "ann", "ben", "carl"])
    >>> found.value, found.n_users
    (0.75, 3)
    """

    value: float
    standard_error: float
    ci95: tuple[float, float] | None
    n_decisions: int
    n_users: int
    influence: Array = field(repr=False)

    def minus(self, other: "ClusteredEstimate") -> "ClusteredEstimate":
        """The difference from an estimate on the same decisions; its interval uses that they are the same users.

        Raises
        ------
        InputError
            The other estimate is from other users.
        """
        if len(self.influence) != len(other.influence):
            raise InputError(
                f"estimates must be from the same users, got {len(self.influence)} and {len(other.influence)}"
            )
        return _estimate(self.value - other.value, self.influence - other.influence, self.n_decisions)

    def to_dict(self) -> dict[str, Any]:
        """Plain data: {"value", "standard_error", "ci95", "n"}; n is the number of users."""
        ci95 = list(self.ci95) if self.ci95 else None
        return {"value": self.value, "standard_error": self.standard_error, "ci95": ci95, "n": self.n_users}


def clustered_estimate(value: float, influence: Array, users: ArrayLike) -> ClusteredEstimate:
    """The estimate of a value whose linear contributions are known.

    Parameters
    ----------
    value : float
    influence : (n,) float64
        Contribution of each decision to value − truth, to first order; sums to 0.
    users : (n,)

    Examples
    --------
    >>> found = clustered_estimate(2.0, np.array([-1.0, 0.0, 1.0, 0.0]) / 4, [0, 0, 1, 2])
    >>> found.n_users, round(found.standard_error, 3)
    (3, 0.433)
    """
    return _estimate(value, user_sums(influence, users), len(influence))


def user_codes(users: ArrayLike) -> NDArray[np.int64]:
    """Place of each row's user among the sorted users, (n,)."""
    return np.unique(np.asarray(users), return_inverse=True)[1].astype(np.int64)


def user_sums(values: Array, users: ArrayLike) -> Array:
    """Sum of the values (n,) of each user, (n_users,), in the order of the sorted users."""
    return np.bincount(user_codes(users), values).astype(np.float64)


def _estimate(value: float, influence: Array, n_decisions: int) -> ClusteredEstimate:
    n = len(influence)
    error = float(np.sqrt(n / max(n - 1, 1) * (influence**2).sum()))
    ci95 = None
    if n >= LEAST_VALUES and error > 0:
        low, high = t_interval(value, error, _degrees_of_freedom(influence))
        ci95 = (float(low), float(high))
    return ClusteredEstimate(float(value), error, ci95, n_decisions, n, influence)


def _degrees_of_freedom(influence: Array) -> float:
    n, squares = len(influence), (influence / np.abs(influence).max()) ** 2
    excess = float((squares**2).sum() / squares.sum() ** 2) - 1 / n
    return float(np.clip(2 / excess, 1, n - 1)) if excess > 0 else n - 1.0
