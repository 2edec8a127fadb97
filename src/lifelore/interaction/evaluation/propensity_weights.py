"""Importance weights of logged decisions, and diagnostics of how much evidence they leave.

    w_t = π(a_t | h_t) / p_t         probability of the logged policy under the target, over that in the log
    w_{1:t} = w_1 w_2 … w_t          over a user's decisions, for targets that depend on earlier outcomes

The expectation of every weight is 1 where the log gives a positive probability to each policy that the target may
choose (support), and where the logged probabilities are right.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.evaluation.estimate_by_user import clustered_estimate, user_codes, user_sums

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

MOST = 1 + 1e-9
"""Largest probability; sums of rounded numbers exceed 1 by less."""


def importance_weights(target: ArrayLike, logged: ArrayLike) -> Array:
    """The weight of each decision, (n,), at least 0.

    Parameters
    ----------
    target : (n,) float
        Probability of the logged policy under the target, in [0, 1].
    logged : (n,) float
        Probability with which the log chose it, above 0 and at most 1.

    Raises
    ------
    InputError
        A probability breaks its rule, or the two are not equally many; the message has the first row.

    Examples
    --------
    >>> importance_weights([1.0, 0.0, 0.5], [0.25, 0.5, 0.5]).tolist()
    [4.0, 0.0, 1.0]
    """
    target, logged = np.asarray(target, np.float64), np.asarray(logged, np.float64)
    if target.ndim != 1 or target.shape != logged.shape:
        raise InputError(f"target and logged must be (n,) alike, got {target.shape} and {logged.shape}")
    _check("logged", logged, (logged > 0) & (logged <= MOST), "above 0 and at most 1")
    _check("target", target, (target >= 0) & (target <= MOST), "in [0, 1]")
    return target / logged


def _check(name: str, values: Array, valid: NDArray[np.bool_], rule: str) -> None:
    if not valid.all():
        row = int(np.flatnonzero(~valid)[0])
        raise InputError(f"{name} must hold probabilities {rule}, got {values[row]:g} in row {row}")


def decision_numbers(users: ArrayLike) -> Numbers:
    """Number of each decision among those of its user, from 0, (n,); rows of a user are in order of time.

    Examples
    --------
    >>> decision_numbers([7, 3, 7, 7, 3]).tolist()
    [0, 0, 1, 2, 1]
    """
    users = np.asarray(users)
    order = np.argsort(users, kind="stable")
    _, starts, counts = np.unique(users[order], return_index=True, return_counts=True)
    numbers = np.empty(len(users), np.int64)
    numbers[order] = np.arange(len(users)) - np.repeat(starts, counts)
    return numbers


def trajectory_weights(weights: Array, users: ArrayLike) -> tuple[Array, Array]:
    """Products of weights along each user's decisions.

    Parameters
    ----------
    weights : (n,) float64
        Of single decisions; rows of a user are in order of time.
    users : (n,)

    Returns
    -------
    before, through : (n,) float64
        Product over the user's earlier decisions, and over those and the decision itself.

    Examples
    --------
    >>> before, through = trajectory_weights(np.array([2.0, 5.0, 3.0]), [0, 1, 0])
    >>> before.tolist(), through.tolist()
    ([1.0, 1.0, 2.0], [2.0, 5.0, 6.0])
    """
    users = user_codes(users)
    numbers = decision_numbers(users)
    order = np.argsort(numbers, kind="stable")
    so_far = np.ones(int(users.max(initial=-1)) + 1)
    before = np.empty(len(users))
    for rows in np.split(order, np.flatnonzero(np.diff(numbers[order])) + 1):
        before[rows] = so_far[users[rows]]
        so_far[users[rows]] *= weights[rows]
    return before, before * weights


@dataclass(frozen=True)
class WeightSummary:
    """Diagnostics of importance weights: mean, largest weight, effective number of users.

    Parameters
    ----------
    mean, standard_error : float
        Mean weight, and its standard error clustered by user; the expectation is 1.
    largest : float
        Largest weight of a decision.
    effective_decisions, effective_users : float
        (Σ w)² / Σ w², over decisions, and over users with the sums of their weights: so many equal weights would
        give the same precision.
    largest_share : float
        Share of the user with the largest sum of weights in the sum of all.

    Examples
    --------
    >>> weight_summary(np.array([2.0, 0.0, 2.0, 0.0]), ["ann", "ann", "ben", "ben"]).mean
    1.0
    """

    mean: float
    standard_error: float
    largest: float
    effective_decisions: float
    effective_users: float
    largest_share: float

    def to_dict(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


def weight_summary(weights: Array, users: ArrayLike) -> WeightSummary:
    """Diagnostics of weights (n,) of the decisions of users (n,); n is at least 1.

    Examples
    --------
    >>> weight_summary(np.array([2.0, 0.0, 2.0, 0.0]), ["ann", "ann", "ben", "ben"]).effective_users
    2.0
    """
    by_user = user_sums(weights, users)
    mean = clustered_estimate(float(weights.mean()), (weights - weights.mean()) / len(weights), users)
    total = float(by_user.sum())
    return WeightSummary(
        mean=mean.value,
        standard_error=mean.standard_error,
        largest=float(weights.max()),
        effective_decisions=_effective(weights),
        effective_users=_effective(by_user),
        largest_share=float(by_user.max()) / total if total else 0.0,
    )


def _effective(weights: Array) -> float:
    largest = weights.max()
    # Scaled, so that no square overflows or vanishes.
    scaled = weights / largest if largest > 0 else weights
    return float(scaled.sum() ** 2 / (scaled**2).sum()) if largest > 0 else 0.0
