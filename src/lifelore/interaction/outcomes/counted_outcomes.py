"""Base of outcome models by counts in cells: bins of a histogram, or distinct values."""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_bins import joined_table
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.cells import Cells
from lifelore.interaction.outcomes.counted_law import CountedLaw, spread_of_counts
from lifelore.interaction.outcomes.log_probability import checked_pseudo_count, log_of
from lifelore.interaction.outcomes.outcome_model import OutcomeModel, stored_spread
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows, chosen_of
from lifelore.interaction.outcomes.prediction import CountedPrediction
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[np.float64]


class CountedOutcomes(OutcomeModel, CountedPrediction):
    """Base of `HistogramOutcomes` and `CategoricalOutcomes`.

    Attributes
    ----------
    cells : Cells
    counts : (n_types, n_policies, n_cells) float
        Weight of every cell, pseudo-counts included; probabilities are shares of the row's sum.
    pseudo_count : float
        Initial weight of each cell of a new type or policy.
    exact : bool
        Whether the counts are exact probabilities, which cannot learn.
    """

    cells_of_places: ClassVar[Any]
    """The class of the cells, called with their places."""

    def __init__(
        self, cells: Cells, counts: Array, pseudo_count: float, exact: bool = False, spread: Spread | None = None
    ) -> None:
        self.cells, self.counts, self.pseudo_count, self.exact = cells, counts, pseudo_count, exact
        self._spread = spread
        if counts.ndim != 3 or not counts.size or counts.shape[2] != len(cells.means):
            raise InputError(f"counts must be (n_types, n_policies, {len(cells.means)}), got {counts.shape}")
        totals = counts.sum(axis=2)
        if not ((counts >= 0).all() and np.isfinite(totals).all() and (totals > 0).all()):
            raise InputError("counts must be at least 0 and finite, with a positive one for every type and policy")
        self._prepare()

    def log_densities(self, policies: Any, values: Any) -> Array:
        """Log densities of many outcomes, (...) and (...) to (..., n_types); without checks."""
        cells = self.cells.of(values)
        found = self._log_by_cell[policies, np.maximum(cells, 0)]
        return np.where(cells[..., None] < 0, -np.inf, found)

    def table(self, n_bins: int = 8) -> SignalTable:
        """The cells as signals; above `n_bins` cells, neighbours are joined so that they tell the types apart."""
        return joined_table(self.probs, n_bins)[1]

    def sample(self, generator: np.random.Generator, type_: int, policy: int, size: Any = None) -> Any:
        """Random outcomes of a pair: a number, or an array of shape `size`."""
        cells = generator.choice(self.probs.shape[2], size, p=self.probs[type_, policy])
        return self.cells.sample(generator, cells)

    def bounds(self) -> tuple[float, float]:
        """(U^min, U^max): the least and the greatest place."""
        return float(self.cells.places[0]), float(self.cells.places[-1])

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """A new model of some types and policies, in the order given; None means all."""
        chosen = np.ix_(chosen_of(types, self.n_types), chosen_of(policies, self.n_policies))
        return self._like(self.counts[chosen])

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        """The model of `to_arrays`, bit for bit."""
        counts, places = np.array(arrays["counts"], np.float64), np.array(arrays["cells"], np.float64)
        pseudo_count, exact = float(arrays["pseudo_count"]), bool(arrays["exact"])
        if counts.ndim != 3:
            raise InputError(f"counts must be (n_policies, n_types, n_cells), got {counts.shape}")
        counts = np.ascontiguousarray(counts.transpose(1, 0, 2))
        return cls.of(cls.cells_of_places(places), counts, pseudo_count, exact, stored_spread(arrays))

    @classmethod
    def of(
        cls, cells: Cells, counts: Array, pseudo_count: float, exact: bool = False, spread: Spread | None = None
    ) -> Self:
        """The model with these cells and counts (n_types, n_policies, n_cells), not copied."""
        model = cls.__new__(cls)
        CountedOutcomes.__init__(model, cells, counts, pseudo_count, exact, spread)
        return model

    @classmethod
    def fitted(cls, cells: Cells, rows: OutcomeRows, pseudo_count: float) -> Self:
        """The model fitted to rows of outcomes."""
        counts = _counted(cells, rows)
        return cls.of(cells, counts + checked_pseudo_count(pseudo_count), pseudo_count)

    def _estimated_spread(self) -> Spread:
        return Spread.known(0.0) if self.exact else spread_of_counts(self.counts, self.pseudo_count)

    def _uncertain_law(self, spread: Spread, dtype: str) -> Any:
        return None if self.exact else CountedLaw(self.counts, spread, self.cells.of, self.cells, dtype)

    def _count(self, type_: int, policy: int, value: float) -> None:
        if self.exact:
            raise InputError("exact probabilities cannot learn; build the model from samples, or give count=")
        self.counts[type_, policy, known_cells(self.cells, np.array([value]))[0]] += 1

    def _count_all(self, type_: int, state: Mapping[str, Any]) -> None:
        self.counts[type_, state["places"][:, 0]] += state["shown"]

    def _parameters(self) -> dict[str, NDArray[Any]]:
        """Counts (policies first), cells and settings."""
        settings = {"pseudo_count": np.array(self.pseudo_count), "exact": np.array(self.exact)}
        counts = np.ascontiguousarray(self.counts.transpose(1, 0, 2))
        return {"counts": counts, "cells": self.cells.places, **settings}

    def _more(self, rows: OutcomeRows, axis: int) -> Self:
        new = _counted(self.cells, rows) + self.pseudo_count
        return self._like(np.concatenate([self.counts, new], axis=axis))

    def _like(self, counts: Array) -> Self:
        return self.of(self.cells, counts, self.pseudo_count, self.exact, self._spread)

    def _prepare(self) -> None:
        for name in ("mean", "deviation"):
            self.__dict__.pop(name, None)
        self.probs = self.counts / self.counts.sum(axis=2, keepdims=True)
        # Policy and cell first: an update reads a row.
        density = self.probs.transpose(1, 2, 0) / self.cells.sizes[:, None]
        self._log_by_cell = log_of(np.ascontiguousarray(density))


def known_cells(cells: Cells, values: Array) -> NDArray[np.int64]:
    """The cells of values (n,); InputError where one has none."""
    found = cells.of(values)
    if (found < 0).any():
        raise InputError(f"outcome {values[found < 0][0]} is outside the model's {cells.extent}; widen them")
    return found


def _counted(cells: Cells, rows: OutcomeRows) -> Array:
    """Weight of the outcomes in each cell, (n_types, n_policies, n_cells)."""
    n_cells, (n_types, n_policies) = len(cells.means), rows.shape
    place = rows.pair * n_cells + known_cells(cells, rows.values)
    counted = np.bincount(place, rows.weights, minlength=n_types * n_policies * n_cells)
    return counted.reshape(n_types, n_policies, n_cells).astype(np.float64)
