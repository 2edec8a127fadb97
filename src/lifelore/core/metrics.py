"""Estimates with 95 % bootstrap intervals: means, paired differences, ratios."""

from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.intervals import bca_interval


@dataclass(frozen=True)
class Estimate:
    """A measured number: value, median, 95 % interval and number of runs.

    `ci95` is None for fewer than three values, which are too few; its ends are equal for three or more values
    without spread. An interval without spread says that all runs agree, not that other runs would.
    """

    value: float
    median: float
    ci95: tuple[float, float] | None
    n: int

    def to_dict(self) -> dict:
        """Plain data: {"value", "median", "ci95", "n"}."""
        plain = asdict(self)
        plain["ci95"] = list(self.ci95) if self.ci95 else None
        return plain


def mean_estimate(values: ArrayLike) -> Estimate:
    """Mean and median of `values` (n,), with a bias-corrected accelerated (BCa) bootstrap interval.

    Examples
    --------
    >>> mean_estimate([1.0, 2.0, 3.0, 4.0]).value
    2.5
    """
    values = _checked(values)
    return Estimate(float(values.mean()), float(np.median(values)), bca_interval([values], np.mean), len(values))


def difference_estimate(values: ArrayLike, others: ArrayLike) -> Estimate:
    """Mean and median of the differences of paired values (n,), with a paired BCa interval.

    Examples
    --------
    >>> difference_estimate([3.0, 4.0, 6.0], [1.0, 2.0, 3.0]).value
    2.3333333333333335
    """
    first, other = _checked(values), _checked(others)
    _check_paired(first, other)
    return mean_estimate(first - other)


def ratio_estimate(numerators: ArrayLike, denominators: ArrayLike) -> Estimate:
    """Ratio of means of paired values, the median of the pairs' own ratios, and a paired BCa interval.

    The median leaves out pairs whose denominator is 0; a mean denominator of 0 gives NaN.
    """
    top, bottom = _checked(numerators), _checked(denominators)
    _check_paired(top, bottom)
    value = float(top.mean() / bottom.mean()) if bottom.mean() else float("nan")
    own = top[bottom != 0] / bottom[bottom != 0]
    median = float(np.median(own)) if len(own) else float("nan")
    return Estimate(value, median, bca_interval([top, bottom], _mean_ratio), len(top))


def _checked(values: ArrayLike) -> NDArray[np.float64]:
    values = np.asarray(values, np.float64).ravel()
    if not values.size or not np.isfinite(values).all():
        raise InputError(
            f"values must be at least one number, all finite, got {values.size} values; drop runs without a result"
        )
    return values


def _check_paired(first: NDArray[np.float64], second: NDArray[np.float64]) -> None:
    if len(first) != len(second):
        raise InputError(f"paired values must agree in number, got {len(first)} and {len(second)}")


def _mean_ratio(tops: NDArray[np.float64], bottoms: NDArray[np.float64], axis: int) -> NDArray[np.float64]:
    below = bottoms.mean(axis=axis)
    return np.divide(tops.mean(axis=axis), below, out=np.full_like(below, np.nan), where=below != 0)


def entropy(probs: ArrayLike) -> NDArray[np.float64]:
    """Entropy in nats of distributions (..., n), (...); 0 log 0 is 0."""
    probs = np.asarray(probs, np.float64)
    # With any finite number in place of the logarithm of 0.
    return 0.0 - np.vecdot(probs, np.log(np.maximum(probs, 1e-300)))
