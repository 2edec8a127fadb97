"""Rows of outcomes that outcome models are fitted to, and checks of outcomes, types and policies.

An outcome (utility, return, performance) is a number; larger is better. Thesis: §4.3.4.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError

Array = NDArray[np.float64]

LARGEST = 1e100
"""Largest size of outcomes and means, and with `LEAST_DEVIATION` the limit that keeps squares finite."""
LEAST_DEVIATION = 1e-50


class OutcomeRows(NamedTuple):
    """Outcomes as rows of type, policy and value.

    types, policies : (n,) int64
    values : (n,) float64, finite
    shape : (n_types, n_policies)
    weights : (n,) float64, as `with_weights` scales them; None counts each row once
    """

    types: NDArray[np.int64]
    policies: NDArray[np.int64]
    values: Array
    shape: tuple[int, int]
    weights: Array | None = None

    @property
    def pair(self) -> NDArray[np.int64]:
        """Each row's pair as one number, type by type, (n,)."""
        return self.types * self.shape[1] + self.policies

    def sums(self, values: Array | None = None) -> Array:
        """Weighted sum of `values` (n,) over each pair's rows, by default their number, (n_types, n_policies)."""
        size = self.shape[0] * self.shape[1]
        if self.weights is not None:
            values = self.weights if values is None else self.weights * values
        return np.bincount(self.pair, values, minlength=size).astype(np.float64).reshape(self.shape)

    def with_weights(self, weights: ArrayLike) -> "OutcomeRows":
        """The rows with reliability weights, scaled for each pair; rows of weight 0 are left out.

        A weight is a row's importance, such as 1 / (probability that it was sampled), and no number of rows: only
        ratios within a pair count. The weights w of a pair are scaled to the sum n = (Σw)² / Σw², Kish's effective
        number of rows. So means are Σwx / Σw, variances have n − 1 degrees of freedom, and counts are n. Equal
        weights give the same bits as none.

        Parameters
        ----------
        weights : (n,) float
            Finite, ≥ 0.

        Raises
        ------
        InputError
            The shape differs, a weight is negative or not finite, or all weights of a pair are 0.

        Examples
        --------
        >>> rows = OutcomeRows(np.array([0, 0, 0]), np.array([0, 0, 0]), np.array([1.0, 2.0, 3.0]), (1, 1))
        >>> rows.with_weights([2.0, 1.0, 1.0]).sums().round(3).tolist()  # 4² / 6
        [[2.667]]
        """
        weights = numbers(weights, f"weights must be numbers of shape {self.values.shape}")
        if weights.shape != self.values.shape:
            raise InputError(f"weights must be {self.values.shape}, one for each outcome, got {weights.shape}")
        if not ((weights >= 0) & np.isfinite(weights)).all():
            raise InputError("weights must be at least 0 and finite, a weight of 0 leaves the outcome out")
        used = weights > 0
        rows = checked_rows(OutcomeRows(self.types[used], self.policies[used], self.values[used], self.shape))
        pair, weights = rows.pair, weights[used]
        # The largest weight of a pair becomes 1, so that no square overflows.
        largest = np.zeros(self.shape[0] * self.shape[1])
        np.maximum.at(largest, pair, weights)
        weights = weights / largest[pair]
        scale = np.bincount(pair, weights)[pair] / np.bincount(pair, weights * weights)[pair]
        return rows._replace(weights=weights * scale)


def numbers(values: ArrayLike, rule: str) -> Array:
    """The values as float64; InputError with the `rule` that they break where they are no such array."""
    try:
        return np.asarray(values, np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{rule}, got {values!r:.80}") from None


def of_shape(values: ArrayLike, shape: tuple[int, ...], name: str) -> Array:
    """A number, or an array of `shape`, as a new float64 array of `shape`; InputError for another shape."""
    found = numbers(values, f"{name} must be one number or of shape {shape}")
    if found.ndim and found.shape != shape:
        raise InputError(f"{name} must be one number or of shape {shape}, got {found.shape}")
    return np.broadcast_to(found, shape).copy()


def rows_of_samples(samples: ArrayLike, weights: ArrayLike | None = None, gaps: bool = False) -> OutcomeRows:
    """The outcomes of `samples` (n_types, n_policies, n), NaN where missing, every pair run unless `gaps`.

    Parameters
    ----------
    weights : (n_types, n_policies, n) float, optional
        See `OutcomeRows.with_weights`; irrelevant where a sample is missing.

    Raises
    ------
    InputError
        The shape differs, a value is infinite, a weight negative, or a pair of type and policy has no sample and
        `gaps` is false.
    """
    samples = numbers(samples, "samples must be numbers of one shape (n_types, n_policies, n), NaN where missing")
    if samples.ndim != 3 or not samples.size:
        raise InputError(f"samples must be (n_types, n_policies, n) numbers, none of them 0, got {samples.shape}")
    types, policies, place = np.nonzero(~np.isnan(samples))
    rows = OutcomeRows(types, policies, samples[types, policies, place], samples.shape[:2])
    if weights is not None:
        given = np.asarray(weights)
        if given.shape != samples.shape:
            raise InputError(f"weights must be {samples.shape}, the shape of samples, got {given.shape}")
        rows = rows.with_weights(given[types, policies, place])
    return checked_rows(rows, gaps)


def checked_rows(rows: OutcomeRows, gaps: bool = False) -> OutcomeRows:
    """The rows, if all are finite and, unless `gaps`, every pair has one (§4.4.1: every pair is run)."""
    if not (np.abs(rows.values) <= LARGEST).all():
        raise InputError(
            f"samples must be finite (NaN where one is missing) and of at most {LARGEST:g}; leave out what is not"
        )
    missing = np.argwhere(rows.sums() == 0)
    if len(missing) and not gaps:
        raise InputError(
            f"every pair of type and policy needs a sample; {len(missing)} have none, the first is type "
            f"{missing[0][0]} with policy {missing[0][1]}: run it, or leave that type or policy out"
        )
    return rows


def rows_of_more(samples: ArrayLike, n_others: int, axis: int, gaps: bool = False) -> OutcomeRows:
    """`samples` (n_others, n) of an additional type (axis 0) or policy (axis 1); see `rows_of_samples`."""
    samples = numbers(samples, "samples must be numbers in rows of one length, NaN where missing")
    if samples.ndim != 2 or len(samples) != n_others:
        others = "policies" if axis == 0 else "types"
        raise InputError(f"samples must be ({n_others}, n), one row for each of the {others}, got {samples.shape}")
    return rows_of_samples(np.expand_dims(samples, axis), gaps=gaps)


def chosen_of(chosen: Sequence[int] | None, n: int) -> NDArray[np.int64]:
    """The chosen numbers below n, all where None; InputError where none is chosen or a number is not below n."""
    if chosen is None:
        return np.arange(n)
    index = np.asarray(chosen)
    if index.ndim != 1 or not index.size or index.dtype.kind not in "iu" or index.min() < 0 or index.max() >= n:
        raise InputError(f"the chosen numbers must be one or more of 0 to {n - 1}, got {chosen}")
    return index.astype(np.int64, copy=False)


def finite_outcomes(values: Any) -> Any:
    """Outcomes, a number or (k,), as float64; InputError where one is not finite."""
    if isinstance(values, float) and -LARGEST <= values <= LARGEST:
        return values
    try:
        found = np.asarray(np.nan if isinstance(values, str) else values, np.float64)
    except (TypeError, ValueError):
        found = np.asarray(np.nan)
    if not (np.abs(found) <= LARGEST).all():
        raise InputError(
            f"value must be a finite number of at most {LARGEST:g}, got {values!r:.80}; leave out what has no "
            "outcome"
        )
    return found


def check_known(what: str, number: Any, n: int) -> None:
    """Raise NotFoundError for a number outside 0 … n - 1; `what` is "policy" or "type"."""
    if not isinstance(number, int | np.integer) or not 0 <= number < n:
        raise NotFoundError(f"unknown {what} {number!r}; this model knows 0 to {n - 1}")


def check_outcome(policy: Any, value: Any, n_policies: int) -> None:
    """Raise an error for an unknown policy, or a value that is no finite number."""
    check_known("policy", policy, n_policies)
    finite_outcomes(np.nan if np.ndim(value) else value)
