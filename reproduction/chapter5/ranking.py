"""Average precision of a ranking with ties."""

import numpy as np
from numpy.typing import ArrayLike


def average_precision(scores: ArrayLike, relevant: ArrayLike) -> float:
    """Expected average precision where items of equal score are ordered by chance (McSherry and Najork 2008).

    Items with higher `scores` ``(n,)`` come first; at least one of `relevant` ``(n,)`` must be true. The result is
    the mean over the relevant items of the precision at their place, in (0, 1].
    """
    scores, hit = np.asarray(scores, float), np.asarray(relevant, bool)
    total, before, found = 0.0, 0, 0
    for score in np.unique(scores)[::-1]:
        tied = scores == score
        n, right = int(tied.sum()), int(hit[tied].sum())
        if right:
            # At a place of the group: the one there, those found before, and its share of those tied before it.
            place = np.arange(n)
            share = (right - 1) / (n - 1) if n > 1 else 0.0
            total += right / n * float(((found + 1 + place * share) / (before + 1 + place)).sum())
        before, found = before + n, found + right
    return total / int(hit.sum())
