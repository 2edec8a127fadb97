"""95 % intervals: BCa bootstrap, percentiles of resamples, Student's t, and Welch's of two groups."""

import warnings
from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.streams import stream

Array = NDArray[np.float64]
Interval = tuple[float, float]

RESAMPLES = 2000
"""Bootstrap samples of an interval; more cost time and make its ends less noisy."""
LEAST_VALUES = 3
"""Values or groups below which there is no interval."""
_BATCH = 10_000_000
"""Numbers of samples less a row that are held at a time; more cost memory (8 bytes each), not time."""


def bca_interval(samples: Sequence[Array], statistic: Callable[..., Any]) -> Interval | None:
    """Bias-corrected accelerated (BCa) bootstrap interval of a statistic, the same for the same data.

    Parameters
    ----------
    samples : sequence of (n,) float64
        Resampled together, as rows.
    statistic : callable
        Takes the samples, each with further axes in front, and ``axis``, which it reduces. Resamples where it is
        not finite are left out.

    Returns
    -------
    (low, high) or None
        None for fewer than `LEAST_VALUES` rows, and where the statistic of the samples is not finite. Two equal
        ends where the rows are all equal, or all resamples give the same: there is no spread.
    """
    from scipy.stats import bootstrap

    n, value = len(samples[0]), statistic(*samples, axis=-1)
    if n < LEAST_VALUES or not np.isfinite(value):
        return None
    if all((sample == sample[0]).all() for sample in samples):
        return float(value), float(value)
    draws = stream(n, "bootstrap").integers(0, n, size=(RESAMPLES, n))
    resampled = statistic(*(sample[draws] for sample in samples), axis=-1)
    resampled = resampled[np.isfinite(resampled)]
    # Equal samples summed in another order differ by rounding; BCa must count them as equal.
    resampled[np.isclose(resampled, value, rtol=1e-12, atol=1e-12 * np.abs(resampled).max())] = value
    if (resampled == value).all():
        return float(value), float(value)
    with warnings.catch_warnings(), np.errstate(invalid="ignore"):
        warnings.simplefilter("ignore")  # an interval that is not finite is left out below
        found = bootstrap(
            samples, statistic, method="BCa", paired=len(samples) > 1, vectorized=True, batch=max(_BATCH // n, 1),
            n_resamples=0, bootstrap_result=SimpleNamespace(bootstrap_distribution=resampled),
        )  # fmt: skip
    low, high = found.confidence_interval
    return (float(low), float(high)) if np.isfinite([low, high]).all() else None


def percentile_interval(resampled: ArrayLike) -> Interval:
    """The 2.5 and 97.5 % quantiles of a statistic of resamples, (n,)."""
    low, high = np.quantile(np.asarray(resampled, float), (0.025, 0.975))
    return float(low), float(high)


def t_interval(value: ArrayLike, error: ArrayLike, degrees: float) -> tuple[Any, Any]:
    """Ends of Student's interval of `value` with a standard error and its degrees of freedom; arrays of arrays."""
    from scipy.special import stdtrit

    half = stdtrit(degrees, 0.975) * np.asarray(error)
    return value - half, value + half


def welch_interval(first: Sequence[float], second: Sequence[float]) -> Interval | None:
    """Welch's interval of mean(first) − mean(second); None for small groups and without spread.

    A group is small below `LEAST_VALUES` values; spread is missing where the values of each group are all equal.
    """
    if min(len(first), len(second)) < LEAST_VALUES:
        return None
    # Equal values that were computed in different ways differ by rounding.
    if np.ptp(first) + np.ptp(second) <= 1e-12 * (np.abs(first).max() + np.abs(second).max()):
        return None
    variances = np.array([np.var(values, ddof=1) / len(values) for values in (first, second)])
    freedom = variances.sum() ** 2 / (variances**2 / (np.array([len(first), len(second)]) - 1)).sum()
    low, high = t_interval(np.mean(first) - np.mean(second), np.sqrt(variances.sum()), freedom)
    return float(low), float(high)
