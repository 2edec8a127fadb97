"""Means and variances of outcomes for each pair of type and policy, shrunk towards the pooled variance.

A few samples estimate a mean well and a deviation badly, and an underestimated deviation makes a belief certain of
the wrong type. Every pair's variance therefore starts from the pooled variance, which counts as `shrinkage`
samples. Another outcome changes the numbers exactly as if it had been there from the start (Welford's update),
except for the pooled variance, which stays. Thesis: §4.4.1, step 4.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.outcome_rows import (
    LARGEST,
    LEAST_DEVIATION,
    OutcomeRows,
    checked_rows,
    chosen_of,
    of_shape,
)

Array = NDArray[np.float64]

FLOOR = 1e-3
"""Least deviation learnt from samples, as a share of their range: equal samples do not prove a deviation of 0."""
OF_PAIRS = ("mean", "variance", "count", "freedom")
"""Fields of `OutcomeMoments` with a number for each pair."""


@dataclass
class OutcomeMoments:
    """Mean and variance of each pair, and the samples behind them; all (n_types, n_policies) float64.

    mean, variance : finite; the variance positive
    count : samples behind the mean; infinite where it is known exactly
    freedom : degrees of freedom behind the variance, shrinkage included
    pooled : variance from which a new pair starts
    shrinkage : samples that the pooled variance counts as
    """

    mean: Array
    variance: Array
    count: Array
    freedom: Array
    pooled: float
    shrinkage: float

    def absorb(self, type_: int, policy: int, count: float, mean: float, squares: float) -> None:
        """Learn from `count` outcomes at once, by their mean and sum of squares around it, in place."""
        pair = type_, policy
        if np.isinf(self.count[pair]):
            raise InputError(
                f"type {type_} with policy {policy} is known exactly and learns nothing; build the model with "
                "count= (the number of samples behind its numbers) to let it learn"
            )
        known, apart = self.count[pair], mean - self.mean[pair]
        total = known + count
        gained = squares + known * count / total * apart**2
        self.variance[pair] = (self.freedom[pair] * self.variance[pair] + gained) / (self.freedom[pair] + count)
        self.mean[pair] += count / total * apart
        self.count[pair], self.freedom[pair] = total, self.freedom[pair] + count

    def more(self, rows: OutcomeRows, axis: int) -> "OutcomeMoments":
        """With the additional type (axis 0) or policy (axis 1) of `rows`; pairs without a row are guessed."""
        new = _moments(rows, self.shrinkage, self.pooled)
        both = {name: (getattr(self, name), getattr(new, name)) for name in OF_PAIRS}
        found = replace(self, **{name: np.concatenate(pair, axis=axis) for name, pair in both.items()})
        found.guess_gaps()
        return found

    def guess_gaps(self) -> None:
        """Give pairs of count 0 what the other pairs say, in place, as less than a single sample.

        The mean is that of the policy's known pairs and of all known pairs, the latter counted as one pair more.
        The count is the variance of an outcome over the variance between types, so that with models in doubt the
        unknown mean varies as means vary between types. With plug-in models the guess is taken for the truth.
        """
        gaps = self.count == 0
        if not gaps.any():
            return
        known = np.ma.masked_array(self.mean, gaps)
        overall = float(known.mean())
        means = (known.sum(axis=0).filled(0.0) + overall) / (known.count(axis=0) + 1)
        several = known.count(axis=0) > 1
        between = float(known[:, several].var(axis=0, ddof=1).mean()) if several.any() else float(known.var())
        self.mean[gaps] = np.broadcast_to(means, self.mean.shape)[gaps]
        self.count[gaps] = np.minimum(self.variance[gaps] / max(between, np.finfo(float).tiny), 1.0)

    def take(self, types: Sequence[int] | None, policies: Sequence[int] | None) -> "OutcomeMoments":
        """The moments of some types and policies."""
        chosen = np.ix_(chosen_of(types, self.mean.shape[0]), chosen_of(policies, self.mean.shape[1]))
        return replace(self, **{name: getattr(self, name)[chosen] for name in OF_PAIRS})

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """All fields by name."""
        return {name: np.array(value) for name, value in vars(self).items()}

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> "OutcomeMoments":
        """The moments of `to_arrays`; InputError where the arrays are no moments."""
        fields = [np.array(arrays[name], np.float64) for name in OF_PAIRS]
        mean, variance, count, freedom = fields
        found = cls(mean, variance, count, freedom, float(arrays["pooled"]), float(arrays["shrinkage"]))
        if found.mean.ndim != 2 or not found.mean.size or any(field.shape != found.mean.shape for field in fields):
            raise InputError(f"mean, variance, count and freedom must share one shape, got {found.mean.shape}")
        good = (np.abs(mean) <= LARGEST) & (variance >= LEAST_DEVIATION**2) & (variance <= LARGEST**2)
        if not (good & (count > 0) & (freedom > 0)).all() or not found.pooled > 0:
            raise InputError("means must be finite, variances, counts and degrees of freedom positive")
        return found


def known_moments(mean: ArrayLike, deviation: ArrayLike, count: ArrayLike | None = None) -> OutcomeMoments:
    """Given means and deviations, exact or as if from `count` samples.

    Raises
    ------
    InputError
        The shapes do not agree, a mean is not finite, or a deviation or count not positive.
    """
    mean = np.array(mean, np.float64)
    if mean.ndim != 2 or not mean.size:
        raise InputError(f"mean must be (n_types, n_policies) numbers, none of them 0, got {mean.shape}")
    deviation = of_shape(deviation, mean.shape, "deviation")
    count = of_shape(np.inf if count is None else count, mean.shape, "count")
    if not (np.abs(mean) <= LARGEST).all():
        raise InputError(
            f"mean must be finite and of at most {LARGEST:g} in every pair; leave out types or policies never run"
        )
    if not ((deviation >= LEAST_DEVIATION) & (deviation <= LARGEST)).all():
        raise InputError(
            f"deviation must be positive, {LEAST_DEVIATION:g} to {LARGEST:g}; use CategoricalOutcomes "
            "where nothing varies"
        )
    if not (count > 0).all():
        raise InputError("count must be positive")
    variance = deviation**2
    return OutcomeMoments(mean, variance, count, count.copy(), float(variance.mean()), 5.0)


def moments(rows: OutcomeRows, shrinkage: float = 5.0, gaps: bool = False) -> OutcomeMoments:
    """Moments of the outcomes, variances shrunk towards the variance within all pairs.

    Raises
    ------
    InputError
        `shrinkage` is negative or infinite, or 0 and a pair's own samples do not differ; a pair has no sample and
        `gaps` is false; or the values overflow.
    """
    if not (shrinkage >= 0 and np.isfinite(shrinkage)):
        raise InputError(f"shrinkage must be at least 0 and finite, got {shrinkage}")
    found = _moments(checked_rows(rows, gaps), shrinkage)
    found.guess_gaps()
    return found


def _moments(rows: OutcomeRows, shrinkage: float, pooled: float | None = None) -> OutcomeMoments:
    """As `moments`, variances shrunk towards `pooled` where given; a pair without a sample has the count 0."""
    count = rows.sums()
    mean = rows.sums(rows.values) / np.where(count > 0, count, 1.0)
    squares = rows.sums((rows.values - mean[rows.types, rows.policies]) ** 2)
    if pooled is None:
        pooled = max(_pooled(squares, count, mean), least_variance(rows.values))
    freedom = np.where(count > 0, shrinkage + count - 1, shrinkage)
    if not shrinkage and not ((count > 1) & (squares > LEAST_DEVIATION**2 * freedom)).all():
        raise InputError("shrinkage must be positive where a pair's own samples do not differ, got 0")
    return OutcomeMoments(mean, (shrinkage * pooled + squares) / freedom, count, freedom, pooled, shrinkage)


def _pooled(squares: Array, count: Array, mean: Array) -> float:
    """Variance within all pairs; where each pair ran once, the variance of means across types or policies."""
    if (freedom := np.maximum(count - 1, 0).sum()) > 0:
        return float(squares.sum() / freedom)
    mean = np.ma.masked_array(mean, count == 0)
    # Noise and differences cannot be separated: all variance counts as noise, so that beliefs move with caution.
    return float(mean.var(axis=0).mean()) if len(mean) > 1 else float(mean.var())


def least_variance(values: Array) -> float:
    """Least variance learnt from `values` (n,), see `FLOOR`."""
    extent = float(values.max() - values.min()) or max(1.0, float(np.abs(values).max()))
    return max(FLOOR * extent, LEAST_DEVIATION) ** 2
