"""Shares of a grid's cells in which something is so, each cell judged by its interval."""

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.metrics import Estimate


def is_above(number: Estimate, bound: float) -> bool:
    """Whether the whole 95 % interval lies above `bound`; False where there is none."""
    return number.ci95 is not None and number.ci95[0] > bound


def is_below(number: Estimate, bound: float) -> bool:
    """Whether the whole 95 % interval lies below `bound`; False where there is none."""
    return number.ci95 is not None and number.ci95[1] < bound


def share_of(cells: ArrayLike) -> Estimate:
    """The share of true `cells` (n,); a count of all there are, so without an interval."""
    cells = np.asarray(cells, float)
    return Estimate(float(cells.mean()), float(np.median(cells)), None, len(cells))
