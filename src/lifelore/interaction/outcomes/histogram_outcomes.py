"""Histogram outcomes over shared edges, with pseudo-counts.

Without pseudo-counts an outcome in a bin that a type never filled excludes that type for ever; with ten samples a
pair that happens in most tasks. Prefer Gaussians below about fifty samples a pair. Thesis: §4.4.1, step 4.
"""

from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.cells import BinCells
from lifelore.interaction.outcomes.counted_outcomes import CountedOutcomes
from lifelore.interaction.outcomes.log_probability import checked_counts, checked_distributions
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows, rows_of_samples

Array = NDArray[np.float64]


class HistogramOutcomes(CountedOutcomes):
    """P(U | type, policy), constant within each bin and 0 outside them.

    Parameters
    ----------
    edges : (n_bins + 1,) float
        Finite and rising; a bin includes its lower edge, the last bin both edges.
    probs : (n_types, n_policies, n_bins) float
        Rows over bins sum to 1.
    count : float, optional
        Number of samples behind every row, so that `observe` can change it; without it rows are exact.

    Raises
    ------
    InputError
        Edges do not rise, or a row is no distribution.

    Examples
    --------
    >>> model = HistogramOutcomes.from_samples([[[0.2, 0.4, 1.5]]], edges=[0.0, 1.0, 2.0])
    >>> model.probs.tolist(), model.mean.tolist()
    ([[[0.625, 0.375]]], [[0.875]])
    """

    kind: ClassVar[str] = "histogram"
    cells_of_places: ClassVar[Any] = BinCells

    def __init__(self, edges: ArrayLike, probs: ArrayLike, count: float | None = None) -> None:
        probs = checked_distributions(probs, "probs", ("n_types", "n_policies", "n_bins"))
        counts = probs * (1.0 if count is None else checked_counts(count, ()))
        super().__init__(BinCells(edges), counts, 0.0 if count is None else 0.5, count is None)

    @property
    def edges(self) -> Array:
        """Edges of the bins, (n_bins + 1,)."""
        return self.cells.places

    @classmethod
    def from_samples(cls, samples: ArrayLike, edges: ArrayLike | int = 20, pseudo_count: float = 0.5) -> Self:
        """The model fitted to `samples` (n_types, n_policies, n), NaN where missing.

        Parameters
        ----------
        edges : (n_bins + 1,) float or int
            Shared by all; or the number of bins over the samples' range, widened by a twentieth at either end.
        pseudo_count : float
            Added to every bin of every pair, ≥ 0.

        Raises
        ------
        InputError
            A pair has no sample, or a sample is outside the edges.
        """
        return cls.from_rows(rows_of_samples(samples), edges, pseudo_count)

    @classmethod
    def from_rows(cls, rows: OutcomeRows, edges: ArrayLike | int = 20, pseudo_count: float = 0.5) -> Self:
        """The model fitted to rows of outcomes; see `from_samples`."""
        number = isinstance(edges, int | np.integer)
        return cls.fitted(BinCells(_edges_over(rows.values, edges) if number else edges), rows, pseudo_count)


def _edges_over(values: Array, n_bins: Any) -> Array:
    if n_bins < 1:
        raise InputError(f"edges must be bin edges or at least 1 bin, got {n_bins}")
    low, high = float(values.min()), float(values.max())
    margin = 0.05 * (high - low) or max(1.0, abs(low)) * 1e-3
    return np.linspace(low - margin, high + margin, int(n_bins) + 1)
