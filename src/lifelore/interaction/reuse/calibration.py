"""Calibration of beliefs and outcome models: predicted probabilities and quantiles beside observed shares.

- Types: of all pairs of a user and a type with a belief of about p, a share p should be right.
- Outcomes: of all outcomes, a share q should lie at or below the predicted quantile of level q. The level of an
  outcome is P(U ≤ u) under the belief before it (probability integral transform, Dawid 1984). An outcome with
  probability of its own covers the levels from P(U < u) to P(U ≤ u), evenly (Czado, Gneiting and Held 2009).

Intervals are 95 %, by the spread between groups, such as users: the predictions for one user hang together.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.user_library import UserLibrary

Array = NDArray[np.float64]

N_BINS = 10
"""Number of bins of predicted probabilities; more are finer and have fewer predictions each."""
LEVELS = tuple(level / 10 for level in range(1, 10))
"""Levels of the predicted quantiles that are compared."""
LEAST_GROUPS = 3
"""Groups behind an interval, or it is left out."""
NORMAL = 1.96
"""Half width of a 95 % interval in deviations."""


@dataclass(frozen=True, eq=False)
class Calibration:
    """Predicted probabilities with the shares observed.

    Parameters
    ----------
    predicted : (k,) float64
        Mean predicted probability of each bin, or level of each quantile; rising.
    observed : (k,) float64
        Share observed.
    low, high : (k,) float64
        95 % interval of the share; NaN with fewer than three groups or without spread.
    n : (k,) int64
        Number of predictions.
    groups : int
        Number of groups behind all of them.
    error : float
        Mean distance of observed from predicted, weighted by `n`: the expected calibration error.
    """

    predicted: Array
    observed: Array
    low: Array
    high: Array
    n: NDArray[np.int64]
    groups: int
    error: float

    def to_dict(self) -> dict[str, Any]:
        """Plain data; intervals that there are not are None."""
        intervals = zip(self.low.tolist(), self.high.tolist(), strict=True)
        return {
            "predicted": self.predicted.tolist(),
            "observed": self.observed.tolist(),
            "ci95": [None if np.isnan(low) else [low, high] for low, high in intervals],
            "n": self.n.tolist(),
            "groups": self.groups,
            "error": self.error,
        }


def type_calibration(beliefs: ArrayLike, types: ArrayLike, groups: ArrayLike | None = None) -> Calibration:
    """Calibration of beliefs over types: every pair of a row and a type is a prediction.

    Predictions are in `N_BINS` bins of equal width over [0, 1]; bins without a prediction are left out.

    Parameters
    ----------
    beliefs : (n, n_types) float
        Rows sum to 1.
    types : (n,) int
        The true types.
    groups : (n,), optional
        Such as the user of each row; by default each row is a group of its own.

    Raises
    ------
    InputError
        Shapes do not agree, there is no row, or a row is no distribution.

    Examples
    --------
    >>> found = type_calibration([[0.8, 0.2], [0.8, 0.2], [0.8, 0.2], [0.8, 0.2]], [0, 0, 0, 1])
    >>> found.predicted.round(2).tolist(), found.observed.tolist(), round(found.error, 3)
    ([0.2, 0.8], [0.25, 0.75], 0.05)
    """
    probs, types = np.asarray(beliefs, np.float64), np.asarray(types)
    if probs.ndim != 2 or not probs.size or types.shape != (len(probs),) or types.dtype.kind not in "iu":
        raise InputError(f"beliefs must be (n, n_types) and types (n,) int, got {probs.shape} and {types.shape}")
    if not ((probs >= 0).all() and (np.abs(probs.sum(axis=1) - 1) <= 1e-6).all()):
        raise InputError("beliefs must be at least 0 and sum to 1 in each row")
    if not 0 <= types.min() <= types.max() < probs.shape[1]:
        raise InputError(f"types must be 0 to {probs.shape[1] - 1}, got {types.min()} to {types.max()}")
    group = np.repeat(_numbered(groups, len(probs)), probs.shape[1])
    right = (np.arange(probs.shape[1]) == types[:, None]).astype(np.float64).ravel()
    probs = probs.ravel()
    # Beliefs that differ from an edge by rounding belong to it.
    bins = np.minimum((probs * N_BINS + 1e-9).astype(np.int64), N_BINS - 1)
    used = np.unique(bins)
    shares = np.array([_share(right[bins == number], group[bins == number]) for number in used])
    predicted = np.array([probs[bins == number].mean() for number in used])
    return _calibration(predicted, shares, np.bincount(bins)[used], len(np.unique(group)))


def outcome_levels(
    library: PolicyLibrary | UserLibrary, beliefs: ArrayLike, policies: ArrayLike, outcomes: ArrayLike
) -> Array:
    """P(U < u) and P(U ≤ u) of outcomes under the belief before each, (n, 2); equal for densities.

    Parameters
    ----------
    library : PolicyLibrary, or what is known of a single user
    beliefs : (n, n_types) float
    policies : (n,) int
    outcomes : (n,) float
        Finite.

    Raises
    ------
    InputError
        Shapes do not agree, an outcome is not finite, or there is no such policy.
    """
    probs, chosen = np.asarray(beliefs, np.float64), np.asarray(policies)
    values = np.asarray(outcomes, np.float64)
    n = len(values) if values.ndim == 1 else -1
    if probs.shape != (n, library.n_types) or chosen.shape != (n,) or not np.isfinite(values).all():
        raise InputError(
            f"beliefs must be (n, {library.n_types}), policies (n,) and outcomes (n,) finite numbers, got "
            f"{probs.shape}, {chosen.shape} and {values.shape}"
        )
    if n and not (chosen.dtype.kind in "iu" and 0 <= chosen.min() <= chosen.max() < library.n_policies):
        raise InputError(f"policies must be numbers from 0 to {library.n_policies - 1}")
    levels = np.empty((n, 2))
    for policy in np.unique(chosen).tolist():
        at = chosen == policy
        for column, own in enumerate((np.nextafter(values[at], -np.inf), values[at])):
            levels[at, column] = (probs[at] * library.performance.cumulative(policy, own).T).sum(axis=1)
    return np.clip(levels, 0.0, 1.0)


def outcome_calibration(
    levels: ArrayLike, groups: ArrayLike | None = None, at: tuple[float, ...] = LEVELS
) -> Calibration:
    """Calibration of predicted quantiles: the share of outcomes at or below each.

    Parameters
    ----------
    levels : (n, 2) float
        Of `outcome_levels`.
    groups : (n,), optional
        Such as the user of each outcome; by default each outcome is a group of its own.
    at : tuple of float
        Levels of the quantiles, rising, within (0, 1).

    Raises
    ------
    InputError
        Levels are none of `outcome_levels`, or there is no outcome.

    Examples
    --------
    >>> outcome_calibration([[0.1, 0.1], [0.4, 0.4], [0.6, 0.6], [0.9, 0.9]], at=(0.5,)).observed.tolist()
    [0.5]
    """
    rows = np.asarray(levels, np.float64)
    if rows.ndim != 2 or rows.shape[1] != 2 or not len(rows):
        raise InputError(f"levels must be (n, 2) with at least one outcome, got {rows.shape}")
    low, high = rows.T
    if not ((low >= 0) & (low <= high + 1e-12) & (high <= 1)).all():
        raise InputError("levels must be P(U < u) and P(U ≤ u) in [0, 1], in this order")
    if not at or not all(0 < level < 1 for level in at):
        raise InputError(f"at must be levels within (0, 1), at least one, got {at}")
    group = _numbered(groups, len(rows))
    width = np.maximum(high - low, 1e-12)
    shares = np.array([_share(np.clip((level - low) / width, 0.0, 1.0), group) for level in at])
    return _calibration(np.array(at), shares, np.full(len(at), len(rows)), len(np.unique(group)))


def _calibration(predicted: Array, shares: Array, n: NDArray[np.int64], groups: int) -> Calibration:
    observed, low, high = shares.T
    error = float((n * np.abs(observed - predicted)).sum() / n.sum())
    return Calibration(predicted, observed, low, high, n.astype(np.int64), groups, error)


def _share(hits: Array, group: NDArray[np.int64]) -> tuple[float, float, float]:
    """Mean of `hits` (n,) in [0, 1], and its interval by the spread between groups (linearised ratio)."""
    share = float(hits.mean())
    _, place = np.unique(group, return_inverse=True)
    n_groups = int(place.max()) + 1
    residual = np.bincount(place, hits - share, minlength=n_groups)
    spread = float((residual**2).sum())
    if n_groups < LEAST_GROUPS or spread <= 1e-18 * len(hits):
        return share, np.nan, np.nan
    half = NORMAL * (spread * n_groups / (n_groups - 1)) ** 0.5 / len(hits)
    return share, max(share - half, 0.0), min(share + half, 1.0)


def _numbered(groups: ArrayLike | None, n: int) -> NDArray[np.int64]:
    if groups is None:
        return np.arange(n)
    given = np.asarray(groups)
    if given.shape != (n,):
        raise InputError(f"groups must be ({n},), one for each row, got {given.shape}")
    return np.unique(given, return_inverse=True)[1]
