"""Cells that outcomes are counted in: distinct values, or bins between edges within which outcomes are uniform.

Cells have

    places           the values, or the edges of the bins
    means, variances of U within each cell, (n_cells,)
    sizes            divisors that turn probabilities of cells into densities, (n_cells,)
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError

Array = NDArray[np.float64]

SAME = 1e-9
"""Outcomes that differ by less, relative to the larger of 1 and their size, are the same value."""


class ValueCells:
    """A cell for each of a few values.

    Parameters
    ----------
    values : (n_cells,) float
        Distinct, finite and rising.

    Raises
    ------
    InputError
        Values are not distinct or do not rise.
    """

    def __init__(self, values: ArrayLike) -> None:
        found = np.array(values, np.float64)
        if found.ndim != 1 or not found.size or not np.isfinite(found).all():
            raise InputError(f"values must be finite numbers, at least one, got shape {found.shape}")
        if not (np.diff(found) > _tolerance(found[:-1])).all():
            raise InputError(f"values must be distinct and rise, by more than {SAME:g} of their size")
        self.places = self.means = found
        self.variances, self.sizes = np.zeros_like(found), np.ones_like(found)

    @property
    def extent(self) -> str:
        """The values in words."""
        return f"values {', '.join(f'{value:g}' for value in self.means[:10])}"

    def of(self, values: ArrayLike) -> NDArray[np.int64]:
        """The cells of values (...), -1 where a value has none."""
        values = np.asarray(values, np.float64)
        above = np.minimum(np.searchsorted(self.means, values), self.means.size - 1)
        below = np.maximum(above - 1, 0)
        nearest = np.where(np.abs(values - self.means[below]) < np.abs(values - self.means[above]), below, above)
        known = self.means[nearest]
        tolerance = np.maximum(_tolerance(values), _tolerance(known))
        return np.where(np.abs(values - known) <= tolerance, nearest, -1)

    def above(self, threshold: Array) -> Array:
        """Whether each value exceeds the threshold, (..., 1) to (..., n_cells)."""
        return (self.means > threshold).astype(np.float64)

    def excess(self, threshold: Array) -> Array:
        """By how much each value exceeds the threshold, (..., 1) to (..., n_cells)."""
        return np.maximum(self.means - threshold, 0.0)

    def sample(self, generator: np.random.Generator, cells: Any) -> Any:
        """The values of cells (...)."""
        return self.means[cells]


class BinCells:
    """Bins between shared edges; a bin includes its lower edge, the last bin both edges.

    Parameters
    ----------
    edges : (n_cells + 1,) float
        Finite and rising.

    Raises
    ------
    InputError
        Edges do not rise.
    """

    def __init__(self, edges: ArrayLike) -> None:
        found = np.array(edges, np.float64)
        if found.ndim != 1 or found.size < 2 or not np.isfinite(found).all():
            raise InputError(f"edges must be finite numbers, one more than bins, got shape {found.shape}")
        if not (np.diff(found) > 0).all():
            raise InputError("edges must rise")
        self.places, self.sizes = found, np.diff(found)
        self.means, self.variances = found[:-1] + 0.5 * self.sizes, self.sizes**2 / 12

    @property
    def extent(self) -> str:
        """The outer edges in words."""
        return f"edges {self.places[0]:g} to {self.places[-1]:g}"

    def of(self, values: ArrayLike) -> NDArray[np.int64]:
        """The bins of values (...), -1 outside the edges."""
        values = np.asarray(values, np.float64)
        cells = np.searchsorted(self.places, values, side="right") - 1
        cells = np.where(values == self.places[-1], self.means.size - 1, cells)
        return np.where(values > self.places[-1], -1, cells)

    def above(self, threshold: Array) -> Array:
        """P(U > threshold) within each bin, (..., 1) to (..., n_cells)."""
        with np.errstate(over="ignore"):
            return np.clip((self.places[1:] - threshold) / self.sizes, 0.0, 1.0)

    def excess(self, threshold: Array) -> Array:
        """E[max(U − threshold, 0)] within each bin, (..., 1) to (..., n_cells)."""
        # Within the threshold's own bin: chance to lie above times half the way to the upper edge.
        over = np.clip(self.places[1:] - threshold, 0.0, self.sizes)
        return np.where(threshold <= self.places[:-1], self.means - threshold, 0.5 * over**2 / self.sizes)

    def sample(self, generator: np.random.Generator, cells: Any) -> Any:
        """Uniform outcomes within bins (...)."""
        return generator.uniform(self.places[cells], self.places[np.asarray(cells) + 1])


Cells = ValueCells | BinCells


def distinct_values(values: Array) -> Array:
    """The values in rising order, each that is the same as the value before it left out.

    In a chain of near values the ends may differ: each is compared with the last that stays, not with its
    neighbour.
    """
    found = np.unique(values)
    if (np.diff(found) > _tolerance(found[:-1])).all():
        return found
    distinct: list[float] = []
    for value in found.tolist():
        if not distinct or value - distinct[-1] > SAME * max(1.0, abs(distinct[-1])):
            distinct.append(value)
    return np.array(distinct)


def _tolerance(values: Array) -> Array:
    return SAME * np.maximum(1.0, np.abs(values))
