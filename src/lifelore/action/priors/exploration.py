"""Turns a prior into exploration rows for Q-learning, or into costs of trying moves for a planned search."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import NotFoundError
from lifelore.core.learning.q_learning import Rows, uniform_rows
from lifelore.core.mdp import Tables

TIES = ("uniform", "prior")
TRACE = 1e-12
"""Least probability of an action; with probability 0 an action could never be chosen."""
TRY_COST = 30.0
"""Steps of detour for each nat beyond `SENSIBLE`; more avoids more collisions. Chosen on a development building:
with 3 to 30 steps, and 0 to 3 nats of `SENSIBLE`, the steps change by a tenth and the collisions fall from a fifth
to 0."""
SENSIBLE = 2.0
"""Nats below the best move of a context within which trying a move costs no detour."""


def prior_rows(
    tables: Tables,
    contexts: ArrayLike,
    probs_of: Callable[[NDArray[np.int64]], ArrayLike],
    ties: str = "uniform",
    reward_class: NDArray[np.integer] | None = None,
) -> Rows:
    """Rows for ε-QSAP and ε-QPAP (Alg. 2, 4), which explore by `probs_of` and break ties by `ties`.

    Parameters
    ----------
    tables : Tables
    contexts : (n_states,) int, or (n_states, n_classes) int
        The state's own number for a state prior, its percept for an observation prior. With `reward_class`, the
        context after each class of the last reward; an episode starts with class 0 (`feature_rows`).
    probs_of : callable
        (n,) codes to (n, n_actions) probabilities, e.g. ``prior.probs``.
    ties : {"uniform", "prior"}
        How the greedy step breaks ties between best actions.
    reward_class : (n_states, n_actions, n_outcomes) int, optional
        Class of each outcome's reward, below n_classes, at most 256.

    Examples
    --------
    >>> from lifelore import ActionPrior, QLearning
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; actions left and right
    >>> tables, prior = Tables.from_matrices(T, [0.0, 0.0, 1.0], terminal=2), ActionPrior(2)
    >>> prior.update([0, 1], [[False, True], [False, True]])
    >>> rows = prior_rows(tables, np.arange(3), prior.probs)
    >>> QLearning(20).learn(tables, 0.9, rows=rows)[1].returns[-1].round(2)
    np.float64(1.0)
    """
    if ties not in TIES:
        raise NotFoundError(f"ties must be one of {', '.join(TIES)}, got '{ties}'")
    codes, row = np.unique(np.asarray(contexts), return_inverse=True)
    probs = np.asarray(probs_of(codes))
    # A tied action of weight zero could never be chosen, so forms with exact zeros get a least weight.
    weights = np.maximum(probs, TRACE) if ties == "prior" else np.ones_like(probs)
    if reward_class is None:
        return uniform_rows(tables, probs, weights, row)
    row = np.ascontiguousarray(row.reshape(np.shape(contexts)), np.int32)
    rows = uniform_rows(tables, probs, weights, row[:, 0])
    return rows._replace(context_row=row, reward_class=np.ascontiguousarray(reward_class, np.uint8))


def try_costs(probs: NDArray[np.float64]) -> NDArray[np.float64]:
    """Cost of trying each move in steps of detour, shaped as `probs`; it orders the moves and excludes none."""
    # The least probability gives excluded moves a large finite cost; an infinite cost would be a mask.
    nats = -np.log(np.maximum(probs / probs.max(axis=1, keepdims=True), TRACE))
    return TRY_COST * np.maximum(0.0, nats - SENSIBLE)
