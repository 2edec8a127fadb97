"""Which scores count as equal to the best: the two tolerances that all rules share, and shares in NumPy."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TOLERANCE = 1e-9
"""Scores this close to the best, relative to it, are equal: rounding moves sums of products by less."""
ROUNDING = 1e-15
"""Differences below this share of a row's largest score are rounding, however small the best score is."""


def shares_of_tied(scores: Array, tolerance: float) -> Array:
    """1 / n for each of the n best of a row, NaN where a score is NaN: the twin of `tie_kernels.tied_rows`."""
    best = scores.max(axis=-1, keepdims=True)
    least = np.where(scores > -np.inf, scores, best).min(axis=-1, keepdims=True)
    with np.errstate(invalid="ignore"):
        bar = best - (tolerance * np.abs(best) + ROUNDING * np.maximum(np.abs(best), np.abs(least)))
    bar = np.where(np.isinf(best), best, bar)
    tied = scores >= bar
    return np.where(np.isnan(best), np.nan, tied / np.maximum(tied.sum(axis=-1, keepdims=True), 1))
