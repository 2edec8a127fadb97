"""Compiled kernels: the largest score of a row with equals at random, and the shares of tied policies."""

import numpy as np

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.interaction.selection.ties import ROUNDING

TIED = -2
"""Return value of `choose_row` where policies tie and `uniform` is negative."""


@inlined
def _bar(scores, tolerance):
    """The least score that counts as best; NaN where a score is."""
    n = scores.shape[0]
    best, least = -np.inf, np.inf
    b0, b1, l0, l1 = -np.inf, -np.inf, np.inf, np.inf
    wrong = 0
    for i in range(n):
        wrong += scores[i] != scores[i]
    # Two at a time: each comparison waits for the last one on its own side only.
    for i in range(0, n - 1, 2):
        b0, b1 = max(b0, scores[i]), max(b1, scores[i + 1])
        l0, l1 = min(l0, scores[i]), min(l1, scores[i + 1])
    if n % 2:
        b0, l0 = max(b0, scores[n - 1]), min(l0, scores[n - 1])
    best, least = max(b0, b1), min(l0, l1)
    if wrong:
        return np.nan
    if abs(best) == np.inf:
        return best
    if least == -np.inf:
        for i in range(n):
            if scores[i] > -np.inf:
                least = min(scores[i], best) if least == -np.inf else min(least, scores[i])
    return best - (tolerance * abs(best) + ROUNDING * max(abs(best), abs(least)))


@inlined
def _place(scores, bar, uniform):
    tied = 0
    for i in range(scores.shape[0]):
        tied += scores[i] >= bar
    if tied == 0:
        return -1
    if tied > 1 and uniform < 0:
        return TIED
    left = int(uniform * tied) if tied > 1 else 0
    for i in range(scores.shape[0]):
        if scores[i] >= bar:
            if left == 0:
                return i
            left -= 1
    return -1


@kernel
def choose_row(scores, uniform, tolerance):
    """Which of `scores` (n,) is the best; `uniform` in [0, 1) decides among equals. -1 where a score is NaN."""
    return _place(scores, _bar(scores, tolerance), uniform)


@kernel
def choose_rows(scores, uniforms, tolerance, chosen):
    """`choose_row` of rows (n, n_policies), into `chosen` (n,)."""
    for k in range(scores.shape[0]):
        chosen[k] = _place(scores[k], _bar(scores[k], tolerance), uniforms[k])


@kernel
def tied_rows(scores, tolerance, shares):
    """1 / n for each of the n best of a row (k, n_policies), 0 for the others; NaN where a score is."""
    for k in range(scores.shape[0]):
        bar = _bar(scores[k], tolerance)
        tied = 0
        for i in range(scores.shape[1]):
            if scores[k, i] >= bar:
                tied += 1
        for i in range(scores.shape[1]):
            if np.isnan(bar):
                shares[k, i] = np.nan
            else:
                shares[k, i] = 1.0 / tied if scores[k, i] >= bar else 0.0
