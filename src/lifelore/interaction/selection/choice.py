"""The policy of the largest score, equals at random."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError
from lifelore.interaction.selection.rule import TOLERANCE
from lifelore.interaction.selection.tie_kernels import choose_row, choose_rows


def choose(scores: ArrayLike, generator: np.random.Generator, tolerance: float = TOLERANCE) -> Any:
    """The policy of the largest score, equals at random.

    Parameters
    ----------
    scores : (..., n_policies) float
        Infinities allowed.
    generator : numpy generator
        Asked for one number where policies tie; for many rows, for one each.
    tolerance : float
        Scores this close to the best, relative to it, are equal; ≥ 0.

    Returns
    -------
    int or (...) int64

    Raises
    ------
    InputError
        A score is NaN, or there is none.

    Examples
    --------
    >>> choose([1.0, 3.0, 2.0], np.random.default_rng(0))
    1
    """
    scores = np.asarray(scores, np.float64)
    if scores.ndim == 1:
        chosen = choose_row(scores, -1.0, tolerance)
        if chosen < -1:
            chosen = choose_row(scores, generator.random(), tolerance)
        if chosen == -1:
            raise InputError("scores must be numbers, at least one, got NaN or nothing")
        return int(chosen)
    rows = np.ascontiguousarray(scores.reshape(-1, scores.shape[-1]))
    policies = np.empty(len(rows), np.int64)
    choose_rows(rows, generator.random(len(rows)), tolerance, policies)
    if (policies < 0).any():
        raise InputError("scores must be numbers, at least one a row, got NaN or nothing")
    return policies.reshape(scores.shape[:-1])
