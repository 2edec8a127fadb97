"""Selects the actions of a policy to count: the best and tied-best ones (Eq. 3.1), in all or in visited states.

Goal rows and completed rows never count. Exact Q-functions are right in all states; learnt Q-functions only in
visited states.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.planning.planning import TIE_TOLERANCE, best_actions

OVER = ("all", "visited")


def actions_to_count(
    q: ArrayLike,
    over: str,
    *,
    ended: ArrayLike | None = None,
    visits: ArrayLike | None = None,
    tolerance: float = TIE_TOLERANCE,
) -> NDArray[np.bool_]:
    """Rows for `ActionPrior.update`: U_s(a), all False in states that do not count, (n_states, n_actions).

    Parameters
    ----------
    q : (n_states, n_actions) float
        Exact or learnt action values.
    over : {"all", "visited"}
        ``all``: every state, for exact values. ``visited``: for learnt ones, only actions tried, and only states
        whose best tried action no longer has the value 0, from which learning starts.
    ended : (n_states,) bool, optional
        Goals and completed configurations, where the episode is over and every action ties.
    visits : (n_states, n_actions) int
        Number of times each action was tried; needed for ``visited``.
    tolerance : float
        Relative distance to the best value within which actions are tied; at least 0. Exact values also use
        the floor of `best_actions`.
    """
    q = np.asarray(q, np.float64)
    if over not in OVER:
        raise NotFoundError(f"over must be one of {', '.join(OVER)}, got '{over}'")
    if not (tolerance >= 0 and np.isfinite(tolerance)):
        raise InputError(f"tolerance must be finite and at least 0, got {tolerance}")
    if over == "visited":
        tried = np.asarray([] if visits is None else visits) > 0
        if tried.shape != q.shape:
            raise InputError(f"over 'visited' needs visits of shape {q.shape}, got {tried.shape}")
        known = np.where(tried, q, -np.inf)
        known[~tried.any(axis=1)] = 0.0
        best = best_actions(known, tolerance, floor=0.0) & tried & (known.max(axis=1, keepdims=True) != 0)
    else:
        best = best_actions(q, tolerance)
    if ended is not None:
        ended = np.asarray(ended, bool)
        if ended.shape != q.shape[:1]:
            raise InputError(f"ended must have shape ({len(q)},), got {ended.shape}")
        best = best & ~ended[:, None]
    return best
