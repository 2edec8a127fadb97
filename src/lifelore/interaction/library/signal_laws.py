"""Expected surprise and expected outcome of the next signal under a belief, for outcomes and for categories.

    m(σ) = Σ β(τ) F(σ | τ, π)            the mixture of the types
    surprise −log m(σ):  expectation −∫ m log m,  variance ∫ m (log m)² − (∫ m log m)²
    shortfall: Σ β(τ) E[U | τ, π] − U, where the signal is the outcome

A density is integrated over cells that are finer than the laws of the types. Categories are their own cells.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.moment_outcomes import MomentOutcomes
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.return_signal import ReturnSignal

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

CELLS = 96
"""Number of cells of a density; more costs time and changes the expected surprise by less than 0.01 nats."""
LEAST = 1e-300
"""Added to probabilities of cells, so that the surprise of an impossible cell, times 0, is 0."""
REACH = 6.0
"""Deviations around the means that the cells cover."""


class Cells(NamedTuple):
    """The signals of a policy as cells.

    probs : (n_types, n_cells) float64, P(cell | type), rows sum to 1
    log_sizes : (n_cells,) float64, log of the width of a cell; 0 for a category
    """

    probs: Array
    log_sizes: Array

    def expected_surprise(self, belief: Array) -> tuple[Array, Array]:
        """Expectation and variance of −log m(σ) under beliefs (n, n_types), (n,) each, in nats."""
        probs = belief @ self.probs
        surprise = self.log_sizes - np.log(probs + LEAST)
        terms = probs * surprise
        expected = terms.sum(axis=1)
        return expected, np.maximum(np.einsum("ij,ij->i", terms, surprise) - expected * expected, 0.0)


class SignalLaws(Protocol):
    """The laws of a library's signals."""

    n_categories: int
    """0 where signals are real numbers."""
    pays: bool
    """Whether a signal is an outcome, so that a shortfall can be computed."""

    def cells(self, policy: int) -> Cells:
        """The signals of a policy as cells."""
        ...

    def log_likelihoods(self, policies: Numbers, signals: Array) -> Array:
        """log F of signals (n,) as `numbers` gives them, (n, n_types)."""
        ...

    def numbers(self, signals: Any) -> Array:
        """Signals as the library's signal model takes them, as numbers (n,): outcomes, or category numbers."""
        ...

    def outcomes(self, numbers: Array) -> Array:
        """The outcomes that the numbers of signals mean, (n,)."""
        ...


class ReturnLaws:
    """Real-valued outcomes as signals.

    Parameters
    ----------
    model : MomentOutcomes or HistogramOutcomes
    """

    n_categories, pays = 0, True

    def __init__(self, model: MomentOutcomes | HistogramOutcomes) -> None:
        self.model = model
        self._cells: dict[int, Cells] = {}

    def cells(self, policy: int) -> Cells:
        """Cells between cuts at equal distances, and at equal shares of the types' outcomes."""
        if policy not in self._cells:
            cuts = self._cuts(policy)
            probs = np.maximum(np.diff(self.model.cumulative(policy, cuts), axis=1), 0.0)
            probs /= probs.sum(axis=1, keepdims=True)
            self._cells[policy] = Cells(probs, np.log(np.diff(cuts)))
        return self._cells[policy]

    def log_likelihoods(self, policies: Numbers, signals: Array) -> Array:
        """Log densities, (n, n_types)."""
        return self.model.log_densities(policies, signals)

    def numbers(self, signals: Any) -> Array:
        """The outcomes themselves."""
        return np.array(signals, np.float64)

    def outcomes(self, numbers: Array) -> Array:
        """The outcomes themselves."""
        return numbers

    def _cuts(self, policy: int) -> Array:
        if isinstance(self.model, HistogramOutcomes):
            return self.model.edges
        mean, deviation = self.model.mean[:, policy], self.model.deviation[:, policy]
        spread = (mean[:, None] + deviation[:, None] * np.linspace(-REACH, REACH, 49)).ravel()
        even = np.linspace(spread.min(), spread.max(), CELLS // 2)
        return np.unique(np.concatenate([even, np.quantile(spread, np.linspace(0, 1, CELLS // 2))]))


class CategoryLaws:
    """Categories as signals, or outcomes of a few values.

    Parameters
    ----------
    probs : (n_types, n_policies, n_categories) float
    values : (n_categories,) float, optional
        The outcomes, where signals are outcomes.
    categories : sequence, optional
        Names of the categories, where signals are names.
    """

    def __init__(self, probs: Array, values: Array | None = None, categories: Sequence[Any] | None = None) -> None:
        self.probs, self.values = probs, values
        self.n_categories, self.pays = probs.shape[2], values is not None
        names = range(self.n_categories) if categories is None else categories
        self._number = {name: number for number, name in enumerate(names)}
        self._sizes = np.zeros(self.n_categories)
        with np.errstate(divide="ignore"):
            self._log = np.log(np.ascontiguousarray(probs.transpose(1, 2, 0)))

    def cells(self, policy: int) -> Cells:
        """The categories."""
        return Cells(self.probs[:, policy], self._sizes)

    def log_likelihoods(self, policies: Numbers, signals: Array) -> Array:
        """Log probabilities of category numbers, (n, n_types)."""
        return self._log[policies, signals.astype(np.int64)]

    def numbers(self, signals: Any) -> Array:
        """Category numbers."""
        if self.values is not None:
            return np.abs(np.array(signals, np.float64)[:, None] - self.values).argmin(axis=1).astype(np.float64)
        return np.array([self._number[signal] for signal in signals], np.float64)

    def outcomes(self, numbers: Array) -> Array:
        """The values of the categories; zeros where categories are no outcomes."""
        number = numbers.astype(np.int64)
        return np.zeros(len(number)) if self.values is None else self.values[number]


def signal_laws(library: PolicyLibrary) -> SignalLaws:
    """The laws of a library's signals.

    Raises
    ------
    InputError
        Signals are neither outcomes nor categories: their expected surprise is unknown.
    """
    signal = library.signal
    if isinstance(signal, CategorySignal):
        return CategoryLaws(signal.probs, None, signal.categories)
    if isinstance(signal, ReturnSignal):
        model = signal.outcomes
        if isinstance(model, CategoricalOutcomes):
            return CategoryLaws(model.probs, model.values)
        if isinstance(model, MomentOutcomes | HistogramOutcomes):
            return ReturnLaws(model)
    raise InputError(
        f"novelty is computed from outcomes or categories, got {type(signal).__name__}; build a second library "
        "whose signals are outcomes, and let the detector observe those"
    )
