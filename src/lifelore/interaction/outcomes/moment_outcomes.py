"""Base of outcome models by mean and variance."""

from collections.abc import Mapping, Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_bins import normal_table
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.law import FixedLaw, Models
from lifelore.interaction.outcomes.normal_law import NormalLaw, spread_of_moments
from lifelore.interaction.outcomes.outcome_model import (
    OutcomeRows,
    check_known,
    check_outcome,
    finite_outcomes,
    rows_of_samples,
)
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments, moments
from lifelore.interaction.outcomes.prediction import NormalPrediction
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[np.float64]


class MomentOutcomes(NormalPrediction):
    """Base of `GaussianOutcomes` and `StudentTOutcomes`.

    Attributes
    ----------
    moments : OutcomeMoments
        Mean and variance of each pair; only `observe` and `absorb` change them.
    mean, deviation : (n_types, n_policies) float
        Of the outcome as the model sees it.
    """

    moments: OutcomeMoments

    def __init__(self, found: OutcomeMoments) -> None:
        self.moments = found
        self._prepare()

    @classmethod
    def from_samples(cls, samples: ArrayLike, shrinkage: float = 5.0, gaps: bool = False) -> Self:
        """The model fitted to `samples` (n_types, n_policies, n), NaN where missing, with shrunk variances.

        Parameters
        ----------
        shrinkage : float
            Number of samples that the pooled variance counts as; ≥ 0. At 0 each pair has its own variance, and
            needs two samples that differ.
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
        return cls.of(moments(rows, shrinkage, gaps))

    @classmethod
    def of(cls, found: OutcomeMoments) -> Self:
        """The model with these moments, not copied."""
        model = cls.__new__(cls)
        MomentOutcomes.__init__(model, found)
        return model

    @property
    def spread(self) -> Spread:
        """How much the tasks of a type differ; estimated at the first call where it is not given."""
        if self.moments.spread is None:
            self.moments.spread = spread_of_moments(self.moments)
        return self.moments.spread

    @spread.setter
    def spread(self, spread: Spread) -> None:
        self.moments.spread = spread

    def law(self, models: Models = "uncertain", *, spread: Spread | None = None, dtype: str = "f8") -> Any:
        """The law of outcomes given what users have shown; a fixed law where all is exact, or taken for the truth.

        Parameters
        ----------
        spread : Spread, optional
            By default the model's own.
        dtype : {"f8", "f4"}
        """
        spread = (spread or self.spread) if models == "uncertain" else Spread.known(0.0)
        exact = np.isinf(self.moments.count).all() and not spread.values.any()
        if models == "plug-in" or exact:
            return FixedLaw(self, self.n_types, self.log_densities, finite_outcomes)
        return NormalLaw(self.moments, spread, dtype)

    def log_density(self, policy: int, value: float) -> Array:
        """Log density of `value` per type, (n_types,).

        Raises
        ------
        InputError
            `value` is no finite number.
        NotFoundError
            There is no such policy.
        """
        check_outcome(policy, value, self.n_policies)
        return self.log_densities(policy, value)

    def log_densities(self, policies: Any, values: Any) -> Array:
        """`log_density` of many outcomes, (...) and (...) to (..., n_types); without checks."""
        raise NotImplementedError

    def bounds(self) -> tuple[float, float]:
        """(U^min, U^max): four deviations around the means."""
        return float((self.mean - 4 * self.deviation).min()), float((self.mean + 4 * self.deviation).max())

    def table(self, n_bins: int = 8) -> SignalTable:
        """The outcome, taken as normal, in bins that tell the types apart, see `signal_bins`."""
        return normal_table(self.mean, self.deviation, n_bins)[1]

    def observe(self, type_: int, policy: int, value: float) -> None:
        """Learn from another outcome of a known type, in place.

        Raises
        ------
        InputError
            `value` is no finite number, or the pair is known exactly.
        NotFoundError
            There is no such type or policy.
        """
        check_known("type", type_, self.n_types)
        check_outcome(policy, value, self.n_policies)
        self.moments.absorb(type_, policy, 1, value, 0.0)
        self._prepare()

    def absorb(self, type_: int, state: Mapping[str, Any]) -> None:
        """Learn from all outcomes of a task whose type has become known, in place.

        `state` is what its law gives of them, see `Law.state`.
        """
        check_known("type", type_, self.n_types)
        for (policy,), (count, mean, squares) in zip(state["places"], state["shown"], strict=True):
            if count > 0:
                self.moments.absorb(type_, policy, count, mean, squares)
        self._prepare()

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

    def _prepare(self) -> None:
        """Compute all arrays that follow from the moments."""
        raise NotImplementedError
