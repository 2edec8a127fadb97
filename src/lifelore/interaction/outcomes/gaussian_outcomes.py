"""Gaussian outcomes of every type and policy: the default performance model.

Thesis: §4.3.4, Fig. 4.1; the expected excess is the textbook expected improvement of a Gaussian.
"""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.interaction.finite_signals.signal_bins import normal_table
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.law import of_users
from lifelore.interaction.outcomes.normal_law import NormalLaw, spread_of_moments
from lifelore.interaction.outcomes.outcome_model import OutcomeModel, stored_spread
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments, known_moments, moments
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows, rows_of_samples
from lifelore.interaction.outcomes.prediction import NormalPrediction, over_types
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[np.float64]

_LOG_ROOT_2_PI = 0.5 * np.log(2 * np.pi)


class GaussianOutcomes(OutcomeModel, NormalPrediction):
    """P(U | type, policy) = Normal(mean, deviation²).

    Parameters
    ----------
    mean : (n_types, n_policies) float
        Finite.
    deviation : float or (n_types, n_policies) float
        Positive.
    count : float or (n_types, n_policies) float, optional
        Number of samples behind the numbers, so that `observe` can change them; without it they are exact.

    Attributes
    ----------
    moments : OutcomeMoments
        Mean and variance of each pair.

    Raises
    ------
    InputError
        A mean is not finite, a deviation or count not positive, or shapes do not agree.

    Examples
    --------
    >>> model = GaussianOutcomes([[0.0, 1.0], [2.0, 1.0]], 1.0)
    >>> model.expected_excess(0.0).round(3).tolist()
    [[0.399, 1.083], [2.008, 1.083]]
    """

    kind: ClassVar[str] = "gaussian"

    def __init__(self, mean: ArrayLike, deviation: ArrayLike, count: ArrayLike | None = None) -> None:
        self.moments = known_moments(mean, deviation, count)
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
        model.moments, model._spread = found, spread
        model._prepare()
        return model

    def log_densities(self, policies: Any, values: Any) -> Array:
        """Log densities of many outcomes, (...) and (...) to (..., n_types); without checks."""
        z = over_types(values) - of_users(self._centre, policies)
        z *= of_users(self._narrow, policies)
        z *= z
        return np.subtract(of_users(self._log_height, policies), z, out=z)

    def bounds(self) -> tuple[float, float]:
        """(U^min, U^max): four deviations around the means."""
        return float((self.mean - 4 * self.deviation).min()), float((self.mean + 4 * self.deviation).max())

    def table(self, n_bins: int = 8) -> SignalTable:
        """The outcome, taken as normal, in bins that tell the types apart, see `signal_bins`."""
        return normal_table(self.mean, self.deviation, n_bins)[1]

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """A new model of some types and policies, in the order given; None means all."""
        return self.of(self.moments.take(types, policies), self._spread)

    def sample(self, generator: np.random.Generator, type_: int, policy: int, size: Any = None) -> Any:
        """Random outcomes of a pair: a number, or an array of shape `size`."""
        return generator.normal(self.mean[type_, policy], self.deviation[type_, policy], size)

    def _prepare(self) -> None:
        self.mean, self.deviation = self.moments.mean, np.sqrt(self.moments.variance)
        # Policy first: an update reads the row of a policy.
        self._centre = np.ascontiguousarray(self.mean.T)
        self._narrow = np.ascontiguousarray(np.sqrt(0.5) / self.deviation.T)
        self._log_height = -np.ascontiguousarray(np.log(self.deviation.T)) - _LOG_ROOT_2_PI

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
