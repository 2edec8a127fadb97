"""The law of cells (categories, values, bins): probabilities known from a finite number of runs, Dirichlet.

Given a type, the probabilities of a pair have a Dirichlet law around those of the library, p, with the weight of
A = 1 / (1/N + ρ) signals: N counts behind p, ρ the spread of the users of a type. After counts c of a user the law
is Dirichlet(A p + c); the next cell i has the probability (A pᵢ + cᵢ) / (A + Σ c). Thesis: §4.4.1.
"""

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.finite_signals.signal_bins import joined, joined_table
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.cells import Cells
from lifelore.interaction.outcomes.law import Law, Numbers, filled
from lifelore.interaction.outcomes.log_probability import log_of
from lifelore.interaction.outcomes.outcome_rows import finite_outcomes
from lifelore.interaction.outcomes.prediction import CountedPrediction
from lifelore.interaction.outcomes.special_functions import gammaln
from lifelore.interaction.outcomes.spread import GRID, Spread, held_out, likeliest

Array = NDArray[Any]


class CountedLaw(Law):
    """P(cell | type, policy) given what each user has shown.

    Parameters
    ----------
    counts : (n_types, n_policies, n_cells) float
        Of the library, pseudo-counts included; read once.
    spread : Spread
    place : callable
        Signals (...) to numbers of cells (...), -1 where a signal has none; InputError for what is no signal.
    cells : Cells, optional
        Of outcomes: their means, and the widths of bins, which turn probabilities into densities.
    dtype : {"f8", "f4"}
        Precision of the statistics and of the likelihoods.

    Attributes
    ----------
    weight : (n_policies, n_spreads, n_types) float
        A: the number of signals that the library's runs count as for a user.
    """

    def __init__(
        self,
        counts: Array,
        spread: Spread,
        place: Callable[[Any], Any],
        cells: Cells | None = None,
        dtype: str = "f8",
    ) -> None:
        self.spread, self.dtype, self._place, self.cells = spread, np.dtype(dtype), place, cells
        self.n_types, self.n_policies, self.n_cells = counts.shape
        self.shape = counts.shape[1:]
        totals = counts.sum(axis=2)
        self.probs = counts / totals[:, :, None]
        self._log_sizes = np.zeros(self.n_cells) if cells is None else np.log(cells.sizes)
        # Policy and cell first: a signal reads the rows of its policy and cell.
        weight = 1 / (1 / totals.T[:, None, :] + spread.values[:, None])
        self.weight: Array = weight.astype(self.dtype)
        self._share = np.ascontiguousarray(self.probs.transpose(1, 2, 0)).astype(self.dtype)
        self._bins: dict[int, tuple[NDArray[np.int64], SignalTable]] = {}

    # ---- the law of signals --------------------------------------------------------------------------------

    def checked(self, signals: Any) -> NDArray[np.int64]:
        """Numbers of cells (...), -1 where a signal has none; InputError where an outcome is not finite."""
        return self._place(signals if self.cells is None else finite_outcomes(signals))

    def log_likelihoods(
        self, policies: Numbers, signals: Any, shown: Array | None = None, users: Numbers = None
    ) -> Array:
        """Log probabilities of cells (...) given what `users` (...) have shown, (..., n_spreads, n_types)."""
        cells, weight = np.maximum(signals, 0), self.weight[policies]
        chosen = weight * self._share[policies, cells][..., None, :]
        if shown is not None:
            counts = shown[users, policies]
            own = np.take_along_axis(counts, np.asarray(cells)[..., None], axis=-1)[..., None]
            chosen, weight = chosen + own, weight + counts.sum(axis=-1)[..., None, None]
        found = log_of(chosen / weight) - self._log_sizes[cells][..., None, None].astype(self.dtype)
        return np.where(np.asarray(signals)[..., None, None] < 0, -np.inf, found)

    def learn(self, shown: Array, users: Numbers, policies: Numbers, signals: Any) -> None:
        """Add cells of distinct users."""
        shown[users, policies, signals] += np.asarray(signals) >= 0

    # ---- what rules read -----------------------------------------------------------------------------------

    def predicted(
        self, shown: Array, users: Numbers, log_weights: Array
    ) -> tuple[tuple[Array, Array], Array, Array, Array]:
        """What tried pairs of a user and a policy predict.

        Returns
        -------
        at : rows and policies, (m,) each
        weights : (m, n_spreads) float, probabilities of the spreads
        probs : (m, n_spreads, n_types, n_cells) float, P(next cell | type, spread)
        total : (m, n_spreads, n_types) float, signals behind the probabilities
        """
        own = shown[np.atleast_1d(users)]
        rows, policies = np.nonzero(own.any(axis=-1))
        counts, weight = own[rows, policies], self.weight[policies]
        total = weight + counts.sum(axis=-1)[:, None, None]
        prior = weight[..., None] * self._share[policies].transpose(0, 2, 1)[:, None]
        weights = np.exp(log_weights).reshape(len(own), -1)[rows]
        return (rows, policies), weights, (prior + counts[:, None, None]) / total[..., None], total

    def prediction(self, shown: Array, users: Numbers, log_weights: Array) -> "CountedRows":
        """The next cell of `users`; `log_weights` (..., n_spreads) are log probabilities of their spreads."""
        return CountedRows(self, shown, users, log_weights)

    def bins(self, n_bins: int) -> tuple[NDArray[np.int64], SignalTable]:
        """Ends of joined cells that tell the types apart, and their table, of users who have shown nothing."""
        if n_bins not in self._bins:
            self._bins[n_bins] = joined_table(self.probs, n_bins)
        return self._bins[n_bins]


class CountedRows(CountedPrediction):
    """The next signals of users, each given what the user has shown; outcomes where cells have means.

    Only pairs of a user and a policy that the user has shown a signal of differ from the library's.
    """

    def __init__(self, law: CountedLaw, shown: Array, users: Numbers, log_weights: Array) -> None:
        self.cells, self._law, self._shape = law.cells, law, np.shape(users)  # pyright: ignore
        self._spread_weights = np.exp(log_weights).reshape(-1, len(law.spread.values))
        self._at, weights, self._by_spread, self._total = law.predicted(shown, users, log_weights)
        self._tried = weights[:, :, None]

    @cached_property
    def probs(self) -> Array:  # pyright: ignore[reportIncompatibleVariableOverride]
        """P(next cell | type, policy), (..., n_types, n_policies, n_cells)."""
        return self._rows(self._law.probs, self._tried_probs)

    def table(self, n_bins: int) -> SignalTable:
        """The cells as signals; above `n_bins` cells, neighbours are joined so that they tell the types apart."""
        ends, table = self._law.bins(n_bins)
        binned = joined(self._tried_probs.transpose(1, 0, 2), ends[self._at[1]]).transpose(1, 0, 2)
        return table.replaced(self._shape, self._at, binned)

    @cached_property
    def _tried_probs(self) -> Array:
        """P(next cell | type) of tried pairs, (m, n_types, n_cells)."""
        return (self._tried[..., None] * self._by_spread).sum(axis=1)

    @cached_property
    def mean_variance(self) -> Array:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Variance of each pair's mean outcome, (..., n_types, n_policies)."""
        law, means = self._law, self.cells.means
        untried = self._within(law.probs) / (1 + law.weight.transpose(1, 2, 0))
        by_spread = self._by_spread @ means
        mean = (self._tried * by_spread).sum(axis=1, keepdims=True)
        unknown = self._within(self._by_spread) / (self._total + 1) + (by_spread - mean) ** 2
        rows = np.tensordot(self._spread_weights, untried, axes=1)
        return self._rows(rows, (self._tried * unknown).sum(axis=1))

    def _within(self, probs: Array) -> Array:
        """Variance of the cells' means under probabilities (..., n_cells)."""
        return np.maximum(probs @ self.cells.means**2 - (probs @ self.cells.means) ** 2, 0.0)

    def _rows(self, untried: Array, tried: Array) -> Array:
        return filled(self._shape, self._at, untried, tried, self._law.n_policies)


def spread_of_counts(counts: Array, pseudo_count: float) -> Spread:
    """The spreads that the types of counts (n_types, n_policies, n_cells) leave possible.

    Each type's own counts are predicted by the laws of the other types (Dirichlet-multinomial).
    """
    n_types, n_policies, n_cells = counts.shape
    if n_types < 2:
        return Spread.known(0.0)
    total = counts.sum(axis=2, keepdims=True)
    probs, seen = counts / total, np.maximum(counts - pseudo_count, 0.0)
    some = held_out(n_types, n_types * n_policies * n_cells)
    found = np.empty((len(GRID), len(some), n_types))
    for number, value in enumerate(GRID):
        prior = 1 / (1 / total + value) * probs
        weight, at_prior = prior.sum(axis=2), np.where(prior > 0, gammaln(np.where(prior > 0, prior, 1.0)), 0.0)
        for place, i in enumerate(some):
            own = seen[i]
            after = np.where(prior + own > 0, gammaln(np.where(prior + own > 0, prior + own, 1.0)), 0.0)
            gain = np.where((prior > 0) | (own == 0), after - at_prior, -np.inf).sum(axis=2)
            found[number, place] = (gain + gammaln(weight) - gammaln(weight + own.sum(axis=1))).sum(axis=1)
            found[number, place, i] = -np.inf
    return Spread.up_to(likeliest(np.maximum(found, -1e300)))
