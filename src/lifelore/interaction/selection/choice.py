"""The policy of the largest score, equals at random; and how likely that choice is to take each policy."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.compiled.compiler_start import kernel_pays
from lifelore.core.errors import InputError
from lifelore.interaction.selection.ties import TOLERANCE, shares_of_tied

Array = NDArray[np.float64]


def choose(scores: ArrayLike, generator: np.random.Generator, tolerance: float = TOLERANCE) -> Any:
    """The policy of the largest score, equals at random.

    Parameters
    ----------
    scores : (..., n_policies) float
        Infinities are allowed.
    generator : numpy generator
        Draws one number where policies tie. For rows of scores it draws one number a row.
    tolerance : float
        Scores this close to the best, relative to it, are equal; ≥ 0.

    Returns
    -------
    int or (...) int64

    Raises
    ------
    InputError
        A score is NaN, or there is no score.

    Examples
    --------
    >>> choose([1.0, 3.0, 2.0], np.random.default_rng(0))
    1
    """
    scores, kernels = np.asarray(scores, np.float64), _loaded or _load()
    if scores.ndim == 1:
        chosen = kernels.choose_row(scores, -1.0, tolerance)
        if chosen < -1:
            chosen = kernels.choose_row(scores, generator.random(), tolerance)
        if chosen == -1:
            raise InputError("scores must be numbers, at least one, got NaN or nothing")
        return int(chosen)
    rows = np.ascontiguousarray(scores.reshape(-1, scores.shape[-1]))
    policies = np.empty(len(rows), np.int64)
    kernels.choose_rows(rows, generator.random(len(rows)), tolerance, policies)
    if (policies < 0).any():
        raise InputError("scores must be numbers, at least one a row, got NaN or nothing")
    return policies.reshape(scores.shape[:-1])


def tied_shares(scores: ArrayLike, tolerance: float = TOLERANCE) -> Array:
    """How likely `choose` is to take each policy, (..., n_policies); InputError where a score is NaN."""
    scores = np.asarray(scores, np.float64)
    if not scores.shape[-1]:
        return np.empty_like(scores)
    if kernel_pays(scores.size):
        rows = np.ascontiguousarray(scores.reshape(-1, scores.shape[-1]))
        shares = np.empty_like(rows)
        (_loaded or _load()).tied_rows(rows, tolerance, shares)
    else:
        shares = shares_of_tied(scores, tolerance)
    if np.isnan(shares).any():
        raise InputError("scores must be numbers, got NaN")
    return shares.reshape(scores.shape)


_loaded: Any = None


def _load() -> Any:
    """The module of kernels, imported at its first use, because the import starts Numba."""
    global _loaded
    from lifelore.interaction.selection import tie_kernels

    _loaded = tie_kernels
    return tie_kernels
