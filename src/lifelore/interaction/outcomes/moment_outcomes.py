"""Base of outcome models by mean and variance."""

from collections.abc import Mapping, Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.interaction.finite_signals.signal_bins import normal_table
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.normal_law import NormalLaw, spread_of_moments
from lifelore.interaction.outcomes.outcome_model import OutcomeModel, stored_spread
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments, moments
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows, rows_of_samples
from lifelore.interaction.outcomes.prediction import NormalPrediction
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[np.float64]


class MomentOutcomes(OutcomeModel, NormalPrediction):
    """Base of `GaussianOutcomes` and `StudentTOutcomes`.

    Attributes
    ----------
    moments : OutcomeMoments
        Mean and variance of each pair.
    mean, deviation : (n_types, n_policies) float
        Of the outcome as the model sees it.
    """

    moments: OutcomeMoments

    def __init__(self, found: OutcomeMoments, spread: Spread | None = None) -> None:
        self.moments, self._spread = found, spread
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
    def of(cls, found: OutcomeMoments, spread: Spread | None = None) -> Self:
        """The model with these moments, not copied."""
        model = cls.__new__(cls)
        MomentOutcomes.__init__(model, found, spread)
        return model

    def bounds(self) -> tuple[float, float]:
        """(U^min, U^max): four deviations around the means."""
        return float((self.mean - 4 * self.deviation).min()), float((self.mean + 4 * self.deviation).max())

    def table(self, n_bins: int = 8) -> SignalTable:
        """The outcome, taken as normal, in bins that tell the types apart, see `signal_bins`."""
        return normal_table(self.mean, self.deviation, n_bins)[1]

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """A new model of some types and policies, in the order given; None means all."""
        return self.of(self.moments.take(types, policies), self._spread)

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        """The model of `to_arrays`, bit for bit."""
        return cls.of(OutcomeMoments.from_arrays(arrays), stored_spread(arrays))

    def _estimated_spread(self) -> Spread:
        return spread_of_moments(self.moments)

    def _uncertain_law(self, spread: Spread, dtype: str) -> Any:
        exact = np.isinf(self.moments.count).all() and not spread.values.any()
        return None if exact else NormalLaw(self.moments, spread, dtype)

    def _count(self, type_: int, policy: int, value: float) -> None:
        self.moments.absorb(type_, policy, 1, value, 0.0)

    def _count_all(self, type_: int, state: Mapping[str, Any]) -> None:
        for (policy,), (count, mean, squares) in zip(state["places"], state["shown"], strict=True):
            if count > 0:
                self.moments.absorb(type_, policy, count, mean, squares)

    def _more(self, rows: OutcomeRows, axis: int) -> Self:
        return self.of(self.moments.more(rows, axis), self._spread)

    def _parameters(self) -> dict[str, NDArray[Any]]:
        return self.moments.to_arrays()
