"""Categorical outcomes: a few values, such as 10 for a successful call and 3 for a failed call.

Thesis: §4.4.2.3, §4.6.2.
"""

from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.cells import ValueCells, distinct_values
from lifelore.interaction.outcomes.counted_outcomes import CountedOutcomes
from lifelore.interaction.outcomes.log_probability import checked_counts, checked_distributions
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows, rows_of_samples

Array = NDArray[np.float64]


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
    cells_of_places: ClassVar[Any] = ValueCells

    def __init__(self, values: ArrayLike, probs: ArrayLike, count: float | None = None) -> None:
        probs = checked_distributions(probs, "probs", ("n_types", "n_policies", "n_values"))
        values = np.array(values, np.float64)
        if values.shape != (probs.shape[2],):
            raise InputError(f"values must be {probs.shape[2]} numbers, one a column of probs, got {values.shape}")
        order = np.argsort(values)
        counts = np.ascontiguousarray(probs[:, :, order]) * (1.0 if count is None else checked_counts(count, ()))
        super().__init__(ValueCells(values[order]), counts, 0.0 if count is None else 0.5, count is None)

    @property
    def values(self) -> Array:
        """The possible outcomes, rising, (n_values,)."""
        return self.cells.places

    @classmethod
    def from_samples(cls, samples: ArrayLike, values: ArrayLike | None = None, pseudo_count: float = 0.5) -> Self:
        """The model fitted to `samples` (n_types, n_policies, n), NaN where missing.

        Parameters
        ----------
        values : (n_values,) float, optional
            All possible values; by default the values of the samples.
        pseudo_count : float
            Added to every value of every pair, ≥ 0.

        Raises
        ------
        InputError
            A pair has no sample, or a sample is not among the values.
        """
        return cls.from_rows(rows_of_samples(samples), values, pseudo_count)

    @classmethod
    def from_rows(cls, rows: OutcomeRows, values: ArrayLike | None = None, pseudo_count: float = 0.5) -> Self:
        """The model fitted to rows of outcomes; see `from_samples`."""
        known = distinct_values(rows.values) if values is None else np.sort(np.array(values, np.float64))
        return cls.fitted(ValueCells(known), rows, pseudo_count)
