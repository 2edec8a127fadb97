"""Base of outcome models by counts in cells: bins of a histogram, or distinct values."""

from collections.abc import Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_bins import check_bins, joined_bins
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.outcomes.batch_likelihood import BatchLikelihood, CalledLikelihood, finite_signals
from lifelore.interaction.outcomes.dirichlet import spread_of_counts
from lifelore.interaction.outcomes.outcome_model import (
    OutcomeRows,
    check_outcome,
    check_type,
    excess_of_means,
    is_outcome,
    refuse_outcome,
)
from lifelore.interaction.outcomes.outcome_moments import chosen_of, rows_of_more
from lifelore.interaction.outcomes.pseudo_counts import PseudoCount, checked_pseudo_count
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.outcomes.task_counts import TaskCounts

Array = NDArray[np.float64]


class CountedOutcomes:
    """Base of `HistogramOutcomes` and `CategoricalOutcomes`.

    Attributes
    ----------
    counts : (n_policies, n_types, n_cells) float
        Weight of every cell, pseudo-counts included; probabilities are shares of the row's sum.
    pseudo_count : float
        Initial weight of each cell of a new type or policy.
    exact : bool
        Whether the counts are exact probabilities, which cannot learn.
    """

    counts: Array
    pseudo_count: float
    exact: bool

    def __init__(self, counts: Array, pseudo_count: float, exact: bool, spread: Spread | None = None) -> None:
        self.counts, self.pseudo_count, self.exact = counts, pseudo_count, exact
        self._spread = spread
        self.totals: Array = np.ascontiguousarray(counts.sum(axis=2))
        if not ((counts >= 0).all() and np.isfinite(self.totals).all() and (self.totals > 0).all()):
            raise InputError("counts must be at least 0 and finite, with a positive one for every type and policy")
        self.mean, self.deviation = self._moments(slice(None))

    @property
    def n_types(self) -> int:
        return self.counts.shape[1]

    @property
    def n_policies(self) -> int:
        return self.counts.shape[0]

    @property
    def n_cells(self) -> int:
        return self.counts.shape[2]

    @property
    def cell_means(self) -> Array:
        """Mean outcome within each cell, (n_cells,)."""
        return self._means()

    @property
    def cell_sizes(self) -> Array:
        """Divisors that turn probabilities of cells into densities, (n_cells,)."""
        return self._sizes()

    def cell_of(self, value: float) -> int | None:
        """The cell of an outcome; None where it has none."""
        cell = int(self._cells(np.array([value], np.float64))[0])
        return None if cell < 0 else cell

    def cells_of(self, values: Array) -> NDArray[np.int64]:
        """The cells of outcomes (n,), -1 where an outcome has none."""
        return self._cells(values)

    @property
    def spread(self) -> Spread:
        """How much the tasks of a type differ; estimated at the first call where it is not given."""
        if self._spread is None:
            self._spread = Spread.known(0.0) if self.exact else spread_of_counts(self.counts, self.pseudo_count)
        return self._spread

    @spread.setter
    def spread(self, spread: Spread) -> None:
        self._spread = spread

    def for_task(self, closest: bool = False) -> TaskCounts | None:
        """A model of one task, which its own outcomes change; None where all is known exactly.

        With `closest` the task is as close to its type as the spread allows.
        """
        return None if self.exact else TaskCounts(self, self.spread.least if closest else self.spread)

    def replace(self, policies: list[int], counts: Array) -> None:
        """Put other counts (n, n_types, n_cells) in the place of those of some policies."""
        self.counts[policies], self.totals[policies] = counts, counts.sum(axis=2)
        self.mean[:, policies], self.deviation[:, policies] = self._moments(policies)

    @property
    def probs(self) -> Array:
        """P(cell | type, policy), (n_types, n_policies, n_cells); made anew at each call."""
        return (self.counts / self.totals[:, :, None]).transpose(1, 0, 2)

    def log_density(self, policy: int, value: float) -> Array:
        """Log density of `value` per type, (n_types,); -inf where a cell has no weight.

        Raises
        ------
        InputError
            `value` is no finite number.
        NotFoundError
            There is no such policy.
        """
        if not is_outcome(policy, value, self.counts.shape[0]):
            refuse_outcome(policy, value, self.n_policies)
        return self.log_densities(np.array([policy]), np.array([value]))[0]

    def log_densities(self, policies: NDArray[np.int64], values: Array) -> Array:
        """`log_density` of many outcomes, (n,) and (n,) to (n, n_types); without checks."""
        policies = np.asarray(policies)
        cells = self._cells(np.asarray(values, np.float64))
        inside = np.maximum(cells, 0)
        found = self.counts[policies, :, inside] / (self.totals[policies] * self._sizes()[inside][:, None])
        found[cells < 0] = 0.0
        return np.log(found, out=np.full_like(found, -np.inf), where=found > 0)

    def batch_likelihood(self) -> BatchLikelihood:
        """Log densities of finite outcomes."""
        return CalledLikelihood(self.log_densities, finite_signals)

    def density(self, value: ArrayLike) -> Array:
        """Density (probability, where outcomes are discrete) of `value` for every pair, (..., T, P)."""
        value = np.asarray(value, np.float64)
        cells = self._cells(value.ravel())
        inside = np.maximum(cells, 0)
        found = self.counts[:, :, inside] / (self.totals[:, :, None] * self._sizes()[inside])
        found[:, :, cells < 0] = 0.0
        return found.transpose(2, 1, 0).reshape(*value.shape, self.n_types, self.n_policies)

    def exceedance(self, threshold: ArrayLike) -> Array:
        """P(U > threshold) for every pair, (..., n_types, n_policies)."""
        return self._expectation(self._above(np.asarray(threshold, np.float64)[..., None]))

    def expected_excess(self, threshold: ArrayLike) -> Array:
        """E[max(U - threshold, 0)] for every pair, exact, (..., n_types, n_policies)."""
        return self._expectation(self._excess(np.asarray(threshold, np.float64)[..., None]))

    def expected_mean_excess(self, threshold: ArrayLike) -> Array:
        """max(mean - threshold, 0) for every pair, (..., n_types, n_policies): the means are taken as exact."""
        return excess_of_means(self.mean, threshold)

    def cumulative(self, policy: int, values: Array, types: Any = slice(None)) -> Array:
        """P(U ≤ value | type, policy) of `values` (n,), for all or some types, (n_types, n)."""
        below = 1 - self._above(values[:, None])
        return self.counts[policy, types] @ below.T / self.totals[policy, types][:, None]

    def table(self, n_bins: int = 8) -> SignalTable:
        """The cells as signals; above `n_bins` cells, neighbours are joined so that they tell the types apart."""
        check_bins(n_bins)
        probs = np.empty((self.n_policies, self.n_types, min(n_bins, self.n_cells)))
        for policy in range(self.n_policies):
            probs[policy] = joined_bins(self.counts[policy] / self.totals[policy][:, None], n_bins)
        return SignalTable(probs)

    def observe(self, type_: int, policy: int, value: float) -> None:
        """Learn from another outcome of a known type, in place.

        Raises
        ------
        InputError
            `value` is no finite number or in no cell, or the probabilities are exact.
        NotFoundError
            There is no such type or policy.
        """
        check_type(type_, self.n_types)
        check_outcome(policy, value, self.n_policies)
        if self.exact:
            raise InputError("exact probabilities cannot learn; build the model from samples, or give count=")
        self.counts[policy, type_, self._known_cells(np.array([value]))[0]] += 1
        self.totals[policy, type_] = self.counts[policy, type_].sum()
        self._renew(type_, policy)

    def absorb(self, type_: int, task: TaskCounts) -> None:
        """Learn from all outcomes of a task whose type has become known, in place."""
        check_type(type_, self.n_types)
        for policy, counts in task.shown.items():
            self.counts[policy, type_] += counts
            self.totals[policy, type_] = self.counts[policy, type_].sum()
            self._renew(type_, policy)

    def with_type(self, samples: ArrayLike) -> Self:
        """A new model with an additional type, from `samples` (n_policies, n), NaN where missing."""
        return self._with(rows_of_more(samples, self.n_policies, 0), axis=1)

    def with_policy(self, samples: ArrayLike) -> Self:
        """A new model with an additional policy, from `samples` (n_types, n), NaN where missing."""
        return self._with(rows_of_more(samples, self.n_types, 1), axis=0)

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """A new model of some types and policies, in the order given; None means all."""
        chosen = np.ix_(chosen_of(policies, self.n_policies), chosen_of(types, self.n_types))
        return self._like(self.counts[chosen])

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """Counts, cells and settings by name."""
        settings = {"pseudo_count": np.array(self.pseudo_count), "exact": np.array(self.exact)}
        if self._spread is not None:
            settings["spread"] = np.array(self._spread)
        return {"counts": self.counts, "cells": self._where(), **settings}

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        """The model of `to_arrays`, bit for bit."""
        try:
            counts, cells = np.array(arrays["counts"], np.float64), np.array(arrays["cells"], np.float64)
            pseudo_count, exact = float(arrays["pseudo_count"]), bool(arrays["exact"])
        except KeyError as error:
            raise InputError(f"an outcome model needs the array {error}") from None
        if counts.ndim != 3 or not counts.size:
            raise InputError(f"counts must be (n_policies, n_types, n_cells), got {counts.shape}")
        spread = Spread.of_array(arrays["spread"]) if "spread" in arrays else None
        return cls.of(cells, counts, pseudo_count, exact, spread)

    @classmethod
    def of(
        cls, cells: Array, counts: Array, pseudo_count: float, exact: bool = False, spread: Spread | None = None
    ) -> Self:
        """The model with these cells and counts, not copied."""
        model = cls.__new__(cls)
        model._place(cells, counts.shape[2])
        CountedOutcomes.__init__(model, counts, pseudo_count, exact, spread)
        return model

    @classmethod
    def _fitted(cls, cells: Array, n_cells: int, rows: OutcomeRows, pseudo_count: PseudoCount) -> Self:
        """The model fitted to rows of outcomes."""
        model = cls.__new__(cls)
        model._place(cells, n_cells)
        counts = model._counted(rows, n_cells)
        number = checked_pseudo_count(pseudo_count, counts)
        return cls.of(cells, counts + number, number)

    def _counted(self, rows: OutcomeRows, n_cells: int) -> Array:
        """Weight of the outcomes in each cell, (n_policies, n_types, n_cells)."""
        n_types, n_policies = rows.shape
        place = (rows.policies * n_types + rows.types) * n_cells + self._known_cells(rows.values)
        counted = np.bincount(place, rows.weights, minlength=n_policies * n_types * n_cells)
        return counted.reshape(n_policies, n_types, n_cells).astype(np.float64)

    def _known_cells(self, values: Array) -> NDArray[np.int64]:
        cells = self._cells(values)
        if (cells < 0).any():
            raise InputError(f"outcome {values[cells < 0][0]} is outside the model's {self._extent()}; widen them")
        return cells

    def _with(self, rows: OutcomeRows, axis: int) -> Self:
        new = self._counted(rows, self.n_cells) + self.pseudo_count
        return self._like(np.concatenate([self.counts, new], axis=axis))

    def _like(self, counts: Array) -> Self:
        return self.of(self._where(), counts, self.pseudo_count, self.exact, self._spread)

    def _expectation(self, of_cells: Array) -> Array:
        """Expectation of a number of each cell, (..., n_cells) to (..., n_types, n_policies)."""
        found = np.tensordot(of_cells, self.counts, axes=([-1], [2])) / self.totals
        return np.ascontiguousarray(np.swapaxes(found, -1, -2))

    def _moments(self, policies: Any) -> tuple[Array, Array]:
        """Mean and deviation of the pairs of some policies."""
        mean = self._row_by_row(self._means(), policies)
        # Squares around the middle of the cells: squares of large numbers would lose their differences.
        middle = 0.5 * (self._means()[0] + self._means()[-1])
        square = self._row_by_row(self._variances() + (self._means() - middle) ** 2, policies)
        return mean, np.sqrt(np.maximum(square - (mean - middle) ** 2, 0.0))

    def _row_by_row(self, of_cells: Array, policies: Any) -> Array:
        """`_expectation` of (n_cells,) whose bits for a pair do not depend on the other pairs."""
        sums = (self.counts[policies] * of_cells).sum(axis=2)
        return np.ascontiguousarray((sums / self.totals[policies]).T)

    def _renew(self, type_: int, policy: int) -> None:
        pair = self.take([type_], [policy])
        self.mean[type_, policy], self.deviation[type_, policy] = pair.mean[0, 0], pair.deviation[0, 0]

    def bounds(self) -> tuple[float, float]:
        """(U^min, U^max): the support."""
        raise NotImplementedError

    def sample(self, generator: np.random.Generator, type_: int, policy: int, size: Any = None) -> Any:
        """Random outcomes of a pair: a number, or an array of shape `size`."""
        raise NotImplementedError

    def _place(self, cells: Array, n_cells: int) -> None:
        """Check and store the places of the cells."""
        raise NotImplementedError

    def _where(self) -> Array:
        """The places of the cells."""
        raise NotImplementedError

    def _extent(self) -> str:
        """The cells in words."""
        raise NotImplementedError

    def _cells(self, values: Array) -> NDArray[np.int64]:
        """Each value's cell, -1 where it has none."""
        raise NotImplementedError

    def _sizes(self) -> Array:
        """Divisors that turn probabilities of cells into densities, (n_cells,)."""
        raise NotImplementedError

    def _means(self) -> Array:
        """Mean of U within each cell, (n_cells,)."""
        raise NotImplementedError

    def _variances(self) -> Array:
        """Variance of U within each cell, (n_cells,)."""
        raise NotImplementedError

    def _above(self, threshold: Array) -> Array:
        """P(U > threshold) within each cell, (..., 1) to (..., n_cells)."""
        raise NotImplementedError

    def _excess(self, threshold: Array) -> Array:
        """E[max(U - threshold, 0)] within each cell, (..., 1) to (..., n_cells)."""
        raise NotImplementedError
