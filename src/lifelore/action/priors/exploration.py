"""What a prior tells a learner: exploration rows for Q-learning, costs of trying for a planned search."""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import NotFoundError
from lifelore.core.learning.q_learning import Rows, uniform_rows
from lifelore.core.mdp import Tables

TIES = ("uniform", "prior")
TRACE = 1e-12
"""Least mass of an action where one of none at all could never be chosen."""
TRY_COST = 30.0
SENSIBLE = 2.0
"""A move whose posterior mean is within e² of the best one's in its context is sensible and costs nothing
extra to try; each further nat costs `TRY_COST` steps of detour. Chosen on a development building: from 0 to 3
nats and 3 to 30 steps the number of steps moves by a tenth, the collisions from a fifth to none."""


def prior_rows(tables: Tables, contexts: NDArray[np.int64], probs_of, ties: str = "uniform") -> Rows:
    """Rows for ε-QSAP and ε-QPAP (Alg. 2, 4): explore as `probs_of` says, break ties as told.

    Parameters
    ----------
    tables : Tables
    contexts : (n_states,) int
        The state's own number for a state prior, its percept for an observation prior.
    probs_of : callable
        (n,) codes to (n, n_actions) probabilities, e.g. ``prior.probs``.
    ties : {"uniform", "prior"}
        How the greedy step breaks ties between best actions.
    """
    if ties not in TIES:
        raise NotFoundError(f"ties must be one of {', '.join(TIES)}, got '{ties}'")
    codes, row = np.unique(contexts, return_inverse=True)
    probs = np.asarray(probs_of(codes))
    # A tied action of weight zero could never be chosen; forms with exact zeros keep a trace of mass.
    weights = np.maximum(probs, TRACE) if ties == "prior" else np.ones_like(probs)
    return uniform_rows(tables, probs, weights, row)


def try_costs(probs: NDArray[np.float64]) -> NDArray[np.float64]:
    """Steps of detour worth making before trying each move, shaped as `probs`: an order, never a mask."""
    # A trace of mass keeps an excluded move dear but possible: an infinite cost would be a mask.
    nats = -np.log(np.maximum(probs / probs.max(axis=1, keepdims=True), TRACE))
    return TRY_COST * np.maximum(0.0, nats - SENSIBLE)
