"""Histogram outcomes over shared edges, with pseudo-counts.

Without pseudo-counts an outcome in a bin that a type never filled excludes that type for ever; with ten samples a
pair that happens in most tasks. Prefer Gaussians below about fifty samples a pair. Thesis: §4.4.1, step 4.
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

    def __init__(self, edges: ArrayLike, probs: ArrayLike, count: float | None = None) -> None:
        probs = checked_distributions(probs, "probs", ("n_types", "n_policies", "n_bins"))
        self._place(np.array(edges, np.float64), probs.shape[2])
        counts = np.ascontiguousarray(probs.transpose(1, 0, 2)) * checked_weight(count)
        super().__init__(counts, 0.0 if count is None else 0.5, count is None)

    @classmethod
    def from_samples(
        cls, samples: ArrayLike, edges: ArrayLike | int = 20, pseudo_count: PseudoCount = 0.5
    ) -> Self:
        """The model fitted to `samples` (n_types, n_policies, n), NaN where missing.

        Parameters
        ----------
        edges : (n_bins + 1,) float or int
            Shared by all; or the number of bins over the samples' range, widened by a twentieth at either end.
        pseudo_count : float or "held-out"
            Added to every bin of every pair, ≥ 0; "held-out" chooses it by held-out likelihood, see
            `outcomes.pseudo_counts`.

        Raises
        ------
        InputError
            A pair has no sample, or a sample is outside the edges.
        """
        return cls.from_rows(rows_of_samples(samples), edges, pseudo_count)

    @classmethod
    def from_rows(cls, rows: OutcomeRows, edges: ArrayLike | int = 20, pseudo_count: PseudoCount = 0.5) -> Self:
        """The model fitted to rows of outcomes; see `from_samples`."""
        edges = (
            _edges_over(rows.values, edges) if isinstance(edges, int | np.integer) else np.array(edges, np.float64)
        )
        return cls._fitted(edges, edges.size - 1, rows, pseudo_count)

    def bounds(self) -> tuple[float, float]:
        """(U^min, U^max): the outer edges."""
        return float(self.edges[0]), float(self.edges[-1])

    def sample(self, generator: np.random.Generator, type_: int, policy: int, size: Any = None) -> Any:
        """Random outcomes of a pair: a number, or an array of shape `size`."""
        share = self.counts[policy, type_] / self.totals[policy, type_]
        bins = generator.choice(self.n_cells, size, p=share)
        return generator.uniform(self.edges[bins], self.edges[bins + 1])

    def _place(self, cells: Array, n_cells: int) -> None:
        if cells.shape != (n_cells + 1,) or n_cells < 1 or not np.isfinite(cells).all():
            raise InputError(f"edges must be {n_cells + 1} finite numbers for {n_cells} bins, got {cells.shape}")
        if not (np.diff(cells) > 0).all():
            raise InputError("edges must rise")
        self.edges = cells

    def _where(self) -> Array:
        return self.edges

    def _extent(self) -> str:
        return f"edges {self.edges[0]:g} to {self.edges[-1]:g}"

    def _cells(self, values: Array) -> NDArray[np.int64]:
        cells = np.searchsorted(self.edges, values, side="right") - 1
        cells[values == self.edges[-1]] = self.edges.size - 2
        cells[values > self.edges[-1]] = -1
        return cells

    def _sizes(self) -> Array:
        return np.diff(self.edges)

    def _means(self) -> Array:
        return self.edges[:-1] + 0.5 * np.diff(self.edges)

    def _variances(self) -> Array:
        return np.diff(self.edges) ** 2 / 12

    def _above(self, threshold: Array) -> Array:
        with np.errstate(over="ignore"):
            return np.clip((self.edges[1:] - threshold) / self._sizes(), 0.0, 1.0)

    def _excess(self, threshold: Array) -> Array:
        # Within the threshold's own bin: chance to lie above times half the way to the upper edge.
        over = np.clip(self.edges[1:] - threshold, 0.0, self._sizes())
        return np.where(threshold <= self.edges[:-1], self._means() - threshold, 0.5 * over**2 / self._sizes())


def _edges_over(values: Array, n_bins: int | np.integer) -> Array:
    if n_bins < 1:
        raise InputError(f"edges must be bin edges or at least 1 bin, got {n_bins}")
    low, high = float(values.min()), float(values.max())
    margin = 0.05 * (high - low) or max(1.0, abs(low)) * 1e-3
    return np.linspace(low - margin, high + margin, int(n_bins) + 1)
