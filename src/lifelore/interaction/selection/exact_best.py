"""Scores of which the largest are exact, where estimates or bounds of all scores cost less.

Policies are computed exactly in the order of their upper bounds, until no other policy can have the largest score.
So the choice is that of exact scores of all policies, equals included.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Policies = NDArray[np.int64]

TIED = 1e-8
"""Scores this close to the best, relative to it, are computed exactly; above the tolerance of `ties`."""
AT_ONCE = 32
"""Number of policies computed at once; more costs time where the first few decide."""


def exact_best(upper: Array, bar: float, exact: Callable[[Policies], Array], always: bool = False) -> Array:
    """`upper` with the exact scores of all policies that may be best, (n_policies,).

    Parameters
    ----------
    upper : (n_policies,) float
        Upper bounds on the scores.
    bar : float
        A lower bound on the largest score; minus infinity where none is known.
    exact : callable
        Numbers of policies (n,) to their exact scores (n,).
    always : bool
        False: where the bounds leave a single policy, its score is not computed either.
    """
    bar -= TIED * abs(bar) if bar > -np.inf else 0.0
    wanted = (upper >= bar).nonzero()[0]
    if len(wanted) < 2 and bar > -np.inf and not always:
        return upper
    order, scores = wanted[np.argsort(-upper[wanted], kind="stable")], upper.copy()
    for start in range(0, len(order), AT_ONCE):
        some = order[start : start + AT_ONCE]
        if upper[some[0]] < bar:
            break
        scores[some] = exact(some)
        best = float(scores[some].max())
        bar = max(bar, best - TIED * abs(best))
    return scores
