"""Pseudo-counts of categories: a number given by the caller, or the number of the largest held-out likelihood.

Each sample is held out once, and predicted from the others of its row with a pseudo-count α on each of K cells.
The log likelihood of all has a closed form of the counts c and the totals n of the rows (Dirichlet-multinomial):

    L(α) = Σ_rows [ Σ_cells c log(c - 1 + α) - n log(n - 1 + K α) ]
"""

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError

PseudoCount = float | Literal["held-out"]
"""Type of the argument `pseudo_count`."""

USUAL = 0.5
"""The pseudo-count where samples show no preference (Jeffreys' prior)."""
SPREAD = np.log(10.0)
"""Standard deviation of log α about `USUAL` before there are samples; more lets few samples move it further."""
CANDIDATES = np.geomspace(1e-3, 1e2, 101)
"""Pseudo-counts that are compared, twenty in each factor of ten; neighbours differ little in likelihood."""


def checked_pseudo_count(pseudo_count: PseudoCount, counts: ArrayLike, possible: ArrayLike | None = None) -> float:
    """The pseudo-count as a number.

    Parameters
    ----------
    pseudo_count : float or "held-out"
        A number at least 0, or "held-out" for `held_out_pseudo_count`.
    counts, possible
        As `held_out_pseudo_count`.

    Raises
    ------
    InputError
        It is negative, not finite, or another word.
    """
    if isinstance(pseudo_count, str):
        if pseudo_count == "held-out":
            return held_out_pseudo_count(counts, possible)
        raise InputError(f"pseudo_count must be a number or 'held-out', got {pseudo_count!r}")
    if not (pseudo_count >= 0 and np.isfinite(pseudo_count)):
        raise InputError(f"pseudo_count must be at least 0 and finite, got {pseudo_count}")
    return pseudo_count


def held_out_pseudo_count(counts: ArrayLike, possible: ArrayLike | None = None) -> float:
    """The pseudo-count under which each sample is best predicted by the others of its row.

    A broad prior on log α about 0.5 decides where samples carry little information. Rows with a single sample
    carry none, so that one sample a row gives 0.5.

    Parameters
    ----------
    counts : (..., n_cells) float
        Number of samples of each cell, without pseudo-counts; rows share one pseudo-count.
    possible : bool, broadcastable to `counts`, optional
        Cells that get the pseudo-count; by default all.

    Returns
    -------
    float
        One of `CANDIDATES`, or 0.5.

    Examples
    --------
    >>> held_out_pseudo_count([[1, 0, 0], [0, 1, 0]])
    0.5
    >>> held_out_pseudo_count([[9, 0, 0], [0, 8, 0], [0, 0, 9]]) < 0.1
    True
    >>> held_out_pseudo_count([[9, 8, 9]] * 9) > 3
    True
    """
    counts = np.asarray(counts, np.float64)
    rows = counts.reshape(-1, counts.shape[-1])
    allowed = np.ones(rows.shape, bool) if possible is None else np.broadcast_to(possible, counts.shape)
    n_cells = allowed.reshape(rows.shape).sum(axis=1)
    total = rows.sum(axis=1)
    if not (total > 1).any():
        return USUAL
    # Equal counts, and rows of equal totals and sizes, are computed once.
    count, times = np.unique(rows[total > 1], return_counts=True)
    held_out = (times * count) @ np.log(np.maximum(count - 1, 0.0)[:, None] + CANDIDATES)
    (n, cells), times = np.unique(np.stack([total, n_cells])[:, total > 1], axis=1, return_counts=True)
    held_out -= (times * n) @ np.log(n[:, None] - 1 + cells[:, None] * CANDIDATES)
    prior = -0.5 * (np.log(CANDIDATES / USUAL) / SPREAD) ** 2
    return float(CANDIDATES[np.argmax(held_out + prior)])
