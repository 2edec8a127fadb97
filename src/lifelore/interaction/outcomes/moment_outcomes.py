"""What outcome models that rest on each pair's mean and variance share: data in, pairs added, taken, stored."""

from collections.abc import Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_bins import informative_table
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.batch_likelihood import BatchLikelihood, CalledLikelihood, finite_signals
from lifelore.interaction.outcomes.outcome_model import OutcomeRows, check_outcome, check_type, rows_of_samples
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments, moments

Array = NDArray[np.float64]


class MomentOutcomes:
    """Base of `GaussianOutcomes` and `StudentTOutcomes`.

    Attributes
    ----------
    moments : OutcomeMoments
        What is known of each pair; changed by `observe` alone.
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
    def from_samples(cls, samples: ArrayLike, shrinkage: float = 5.0) -> Self:
        """Fitted to `samples` (n_types, n_policies, n), NaN where missing, variances shrunk.

        Parameters
        ----------
        shrinkage : float
            Samples that the variance shared by all pairs counts as; > 0.

        Raises
        ------
        InputError
            A pair has no sample, or a sample is infinite.
        """
        return cls.from_rows(rows_of_samples(samples), shrinkage)

    @classmethod
    def from_rows(cls, rows: OutcomeRows, shrinkage: float = 5.0) -> Self:
        """Fitted to outcomes one a row; see `from_samples`."""
        return cls.of(moments(rows, shrinkage))

    @classmethod
    def of(cls, found: OutcomeMoments) -> Self:
        """The model that rests on these moments, kept and not copied."""
        model = cls.__new__(cls)
        MomentOutcomes.__init__(model, found)
        return model

    @property
    def n_types(self) -> int:
        return self.mean.shape[0]

    @property
    def n_policies(self) -> int:
        return self.mean.shape[1]

    def log_densities(self, policies: NDArray[np.int64], values: Array) -> Array:
        """Log densities of many outcomes at once, (n,) and (n,) to (n, n_types)."""
        raise NotImplementedError

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
        """Learn from one more outcome of a known type, in place.

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

    def with_type(self, samples: ArrayLike) -> Self:
        """A new model with one type more, from `samples` (n_policies, n), NaN where missing."""
        return self.of(self.moments.more(samples, axis=0))

    def with_policy(self, samples: ArrayLike) -> Self:
        """A new model with one policy more, from `samples` (n_types, n), NaN where missing."""
        return self.of(self.moments.more(samples, axis=1))

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """A new model of some types and policies, in the order given; None keeps all."""
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
        """Make all that is derived from the moments."""
        raise NotImplementedError

    def _renew(self, type_: int, policy: int) -> None:
        """Make it anew for one pair."""
        raise NotImplementedError
