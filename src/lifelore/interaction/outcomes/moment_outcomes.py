"""Base of outcome models by mean and variance."""

from collections.abc import Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_bins import informative_table
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.batch_likelihood import BatchLikelihood, CalledLikelihood, finite_signals
from lifelore.interaction.outcomes.outcome_model import (
    OutcomeRows,
    check_outcome,
    check_type,
    excess_of_means,
    rows_of_samples,
)
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments, moments
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.outcomes.task_normals import TaskNormals, spread_of

Array = NDArray[np.float64]


class MomentOutcomes:
    """Base of `GaussianOutcomes` and `StudentTOutcomes`.

    Attributes
    ----------
    moments : OutcomeMoments
        Mean and variance of each pair; only `observe` changes them.
    mean, deviation : (n_types, n_policies) float
        Of the outcome as the model sees it.
    """

    moments: OutcomeMoments
    mean: Array
    deviation: Array

    def __init__(self, found: OutcomeMoments) -> None:
        self.moments = found
        self.mean = found.mean
        self._prepare()

    @classmethod
    def from_samples(cls, samples: ArrayLike, shrinkage: float = 5.0, gaps: bool = False) -> Self:
        """The model fitted to `samples` (n_types, n_policies, n), NaN where missing, with shrunk variances.

        Parameters
        ----------
        shrinkage : float
            Number of samples that the pooled variance counts as; > 0.
        gaps : bool
            Whether pairs without a sample are guessed from the others, see `OutcomeMoments.guess_gaps`.

        Raises
        ------
        InputError
            A pair has no sample and `gaps` is false, or a sample is infinite.
        """
        return cls.from_rows(rows_of_samples(samples, gaps=gaps), shrinkage, gaps)

    @classmethod
    def from_rows(cls, rows: OutcomeRows, shrinkage: float = 5.0, gaps: bool = False) -> Self:
        """The model fitted to rows of outcomes; see `from_samples`."""
        return cls.of(moments(rows, shrinkage, gaps=gaps))

    @classmethod
    def of(cls, found: OutcomeMoments) -> Self:
        """The model with these moments, not copied."""
        model = cls.__new__(cls)
        MomentOutcomes.__init__(model, found)
        return model

    @property
    def n_types(self) -> int:
        return self.mean.shape[0]

    @property
    def n_policies(self) -> int:
        return self.mean.shape[1]

    @property
    def spread(self) -> Spread:
        """How much the tasks of a type differ; estimated at the first call where it is not given."""
        if self.moments.spread is None:
            self.moments.spread = spread_of(self.moments)
        return self.moments.spread

    @spread.setter
    def spread(self, spread: Spread) -> None:
        self.moments.spread = spread

    def for_task(self, closest: bool = False) -> TaskNormals | None:
        """A model of one task, which its own outcomes change; None where all is known exactly.

        With `closest` the task is as close to its type as the spread allows.
        """
        spread = self.spread.least if closest else self.spread
        if np.isinf(self.moments.count).all() and not spread.values.any():
            return None
        return TaskNormals(self.moments, spread)

    def log_densities(self, policies: NDArray[np.int64], values: Array) -> Array:
        """Log densities of many outcomes at once, (n,) and (n,) to (n, n_types)."""
        raise NotImplementedError

    def expected_mean_excess(self, threshold: ArrayLike) -> Array:
        """max(mean - threshold, 0) for every pair, (..., n_types, n_policies): the means are taken as exact."""
        return excess_of_means(self.mean, threshold)

    def batch_likelihood(self) -> BatchLikelihood:
        """Log densities of finite outcomes."""
        return CalledLikelihood(self.log_densities, finite_signals)

    def bounds(self) -> tuple[float, float]:
        """(U^min, U^max): four deviations around the means."""
        return float((self.mean - 4 * self.deviation).min()), float((self.mean + 4 * self.deviation).max())

    def table(self, n_bins: int = 8) -> SignalTable:
        """The outcome in bins that tell the types apart, see `signal_bins`."""
        return informative_table(self, n_bins)

    def observe(self, type_: int, policy: int, value: float) -> None:
        """Learn from another outcome of a known type, in place.

        Raises
        ------
        InputError
            `value` is no finite number, or the pair is known exactly.
        NotFoundError
            There is no such type or policy.
        """
        check_type(type_, self.n_types)
        check_outcome(policy, value, self.n_policies)
        self.moments.observe(type_, policy, value)
        self._renew(type_, policy)

    def absorb(self, type_: int, task: TaskNormals) -> None:
        """Learn from all outcomes of a task whose type has become known, in place."""
        check_type(type_, self.n_types)
        for policy, (count, mean, squares) in task.shown.items():
            if count > 0:
                self.moments.absorb(type_, policy, count, mean, squares)
                self._renew(type_, policy)

    def with_type(self, samples: ArrayLike, gaps: bool = False) -> Self:
        """A new model with an additional type, from `samples` (n_policies, n); see `from_samples`."""
        return self.of(self.moments.more(samples, 0, gaps))

    def with_policy(self, samples: ArrayLike, gaps: bool = False) -> Self:
        """A new model with an additional policy, from `samples` (n_types, n); see `from_samples`."""
        return self.of(self.moments.more(samples, 1, gaps))

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """A new model of some types and policies, in the order given; None means all."""
        return self.of(self.moments.take(types, policies))

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """The moments by name."""
        return self.moments.to_arrays()

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        """The model of `to_arrays`, bit for bit."""
        try:
            return cls.of(OutcomeMoments.from_arrays(arrays))
        except KeyError as error:
            raise InputError(f"an outcome model needs the array {error}") from None

    def cumulative(self, policy: int, values: Array, types: Any = slice(None)) -> Array:
        """P(U ≤ value | type, policy) of `values` (n,), for all or some types, (n_types, n)."""
        raise NotImplementedError

    def _prepare(self) -> None:
        """Compute all arrays that are derived from the moments."""
        raise NotImplementedError

    def _renew(self, type_: int, policy: int) -> None:
        """Compute the derived arrays again for a pair."""
        raise NotImplementedError
