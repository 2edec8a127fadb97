"""Categorical outcomes: a few values, such as 10 for a successful call and 3 for a failed call.

Thesis: §4.4.2.3, §4.6.2.
"""

from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.counted_outcomes import CountedOutcomes
from lifelore.interaction.outcomes.log_probability import checked_distributions, checked_weight
from lifelore.interaction.outcomes.outcome_model import OutcomeRows, rows_of_samples
from lifelore.interaction.outcomes.pseudo_counts import PseudoCount

Array = NDArray[np.float64]

SAME = 1e-9
"""Outcomes that differ by less, relative to the larger of 1 and their size, are the same value."""


class CategoricalOutcomes(CountedOutcomes):
    """P(U = value | type, policy) over a list of values; densities are probabilities.

    Parameters
    ----------
    values : (n_values,) float
        Distinct and finite, in any order; stored in rising order.
    probs : (n_types, n_policies, n_values) float
        Rows over values, in the order given, sum to 1.
    count : float, optional
        Number of samples behind every row, so that `observe` can change it; without it rows are exact.

    Raises
    ------
    InputError
        Values are not distinct, or a row is no distribution.

    Examples
    --------
    >>> model = CategoricalOutcomes([10, 3], [[[1.0, 0.0]], [[0.25, 0.75]]])
    >>> model.values.tolist(), model.mean.tolist()
    ([3.0, 10.0], [[10.0], [4.75]])
    """

    kind: ClassVar[str] = "categorical"

    def __init__(self, values: ArrayLike, probs: ArrayLike, count: float | None = None) -> None:
        probs = checked_distributions(probs, "probs", ("n_types", "n_policies", "n_values"))
        values = np.array(values, np.float64)
        if values.shape != (probs.shape[2],):
            raise InputError(f"values must be {probs.shape[2]} numbers, one a column of probs, got {values.shape}")
        order = np.argsort(values)
        self._place(values[order], probs.shape[2])
        counts = np.ascontiguousarray(probs.transpose(1, 0, 2)[:, :, order]) * checked_weight(count)
        super().__init__(counts, 0.0 if count is None else 0.5, count is None)

    @classmethod
    def from_samples(
        cls, samples: ArrayLike, values: ArrayLike | None = None, pseudo_count: PseudoCount = 0.5
    ) -> Self:
        """The model fitted to `samples` (n_types, n_policies, n), NaN where missing.

        Parameters
        ----------
        values : (n_values,) float, optional
            All possible values; by default the values of the samples.
        pseudo_count : float or "held-out"
            Added to every value of every pair, ≥ 0; "held-out" chooses it by held-out likelihood, see
            `outcomes.pseudo_counts`.

        Raises
        ------
        InputError
            A pair has no sample, or a sample is not among the values.
        """
        return cls.from_rows(rows_of_samples(samples), values, pseudo_count)

    @classmethod
    def from_rows(
        cls, rows: OutcomeRows, values: ArrayLike | None = None, pseudo_count: PseudoCount = 0.5
    ) -> Self:
        """The model fitted to rows of outcomes; see `from_samples`."""
        known = _distinct(rows.values) if values is None else np.sort(np.array(values, np.float64))
        return cls._fitted(known, known.size, rows, pseudo_count)

    def bounds(self) -> tuple[float, float]:
        """(U^min, U^max): the least and the greatest value."""
        return float(self.values[0]), float(self.values[-1])

    def sample(self, generator: np.random.Generator, type_: int, policy: int, size: Any = None) -> Any:
        """Random outcomes of a pair: a number, or an array of shape `size`."""
        return generator.choice(self.values, size, p=self.counts[policy, type_] / self.totals[policy, type_])

    def _place(self, cells: Array, n_cells: int) -> None:
        if cells.shape != (n_cells,) or n_cells < 1 or not np.isfinite(cells).all():
            raise InputError(f"values must be {n_cells} finite numbers, got shape {cells.shape}")
        if n_cells > 1 and not (np.diff(cells) > _tolerance(cells[:-1])).all():
            raise InputError(f"values must be distinct, by more than {SAME:g} of their size")
        self.values = cells

    def _where(self) -> Array:
        return self.values

    def _extent(self) -> str:
        return f"values {', '.join(f'{value:g}' for value in self.values[:10])}"

    def cell_of(self, value: float) -> int | None:
        """The cell of an outcome; None where it has none. As `cells_of`, faster for a single outcome."""
        above = min(int(np.searchsorted(self.values, value)), self.values.size - 1)
        below = max(above - 1, 0)
        to_below, to_above = abs(value - float(self.values[below])), abs(value - float(self.values[above]))
        nearest, apart = (below, to_below) if to_below < to_above else (above, to_above)
        return nearest if apart <= SAME * max(1.0, abs(value), abs(float(self.values[nearest]))) else None

    def _cells(self, values: Array) -> NDArray[np.int64]:
        above = np.minimum(np.searchsorted(self.values, values), self.values.size - 1)
        below = np.maximum(above - 1, 0)
        nearer = np.abs(values - self.values[below]) < np.abs(values - self.values[above])
        nearest = np.where(nearer, below, above)
        known = self.values[nearest]
        tolerance = np.maximum(_tolerance(values), _tolerance(known))
        return np.where(np.abs(values - known) <= tolerance, nearest, -1)

    def _sizes(self) -> Array:
        return np.ones_like(self.values)

    def _means(self) -> Array:
        return self.values

    def _variances(self) -> Array:
        return np.zeros_like(self.values)

    def _above(self, threshold: Array) -> Array:
        return (self.values > threshold).astype(np.float64)

    def _excess(self, threshold: Array) -> Array:
        return np.maximum(self.values - threshold, 0.0)


def _tolerance(values: Array) -> Array:
    return SAME * np.maximum(1.0, np.abs(values))


def _distinct(values: Array) -> Array:
    """The values in rising order, each that is the same as the one kept before it left out.

    In a chain of near values the ends may differ: each is compared with the last that is kept, not with its
    neighbour.
    """
    found = np.unique(values)
    if (np.diff(found) > _tolerance(found[:-1])).all():
        return found
    kept: list[float] = []
    for value in found.tolist():
        if not kept or value - kept[-1] > SAME * max(1.0, abs(kept[-1])):
            kept.append(value)
    return np.array(kept)
