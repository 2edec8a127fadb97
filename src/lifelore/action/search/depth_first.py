"""Depth-first search that tries actions in the order of a prior.

No state is entered twice. A prior may also prune: actions with a probability below a threshold are not tried, and
the search may then miss all paths. Thesis: §3.8.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.errors import InputError
from lifelore.core.mdp import TERMINAL, Tables


class Preferences(NamedTuple):
    """Actions in the order in which they are tried.

    order : (n_states, n_actions) int32, a permutation in each row
    n_tried : (n_states,) int32, number of the actions that are tried, at least 1
    """

    order: NDArray[np.int32]
    n_tried: NDArray[np.int32]


class DepthFirstResult(NamedTuple):
    """Result of a search: whether it found a terminal move, number of expanded nodes, actions of the path."""

    reached: bool
    expanded: int
    actions: NDArray[np.int32]


def preferences(probs: NDArray[np.float64], generator: np.random.Generator, prune: float = 0.0) -> Preferences:
    """Order of the actions of each state: more probable actions first, ties in a random order for each state.

    Parameters
    ----------
    probs : (n_states, n_actions) float
        Action probabilities, e.g. ``ActionPrior.probs`` of the states' contexts; uniform rows give the
        search without a prior, in random order.
    generator : numpy generator
    prune : float
        In [0, 1]: actions of smaller probability are left out, except the most probable action.
    """
    probs = np.asarray(probs, np.float64)
    if probs.ndim != 2 or not probs.shape[1]:
        raise InputError(f"probs must be (n_states, n_actions), got shape {probs.shape}")
    if not 0 <= prune <= 1:
        raise InputError(f"prune must lie in [0, 1], got {prune}")
    order = np.lexsort((generator.random(probs.shape), -probs), axis=1)
    n_tried = (np.take_along_axis(probs, order, axis=1) >= prune).sum(axis=1)
    return Preferences(order.astype(np.int32), np.maximum(n_tried, 1).astype(np.int32))


def depth_first(tables: Tables, start: int, preferred: Preferences) -> DepthFirstResult:
    """Search from `start` for a terminal move, and enter no state twice.

    A node is expanded when its first action is tried.

    Raises
    ------
    InputError
        The world is not deterministic, or `start` or `preferred` do not fit it.
    """
    _check(tables, start, preferred)
    path = np.empty(tables.n_states, np.int32)
    reached, expanded, length = _descend(
        tables.next_state, tables.event, preferred.order, preferred.n_tried, start, path
    )
    return DepthFirstResult(bool(reached), int(expanded), path[:length].copy())


def _check(tables: Tables, start: int, preferred: Preferences) -> None:
    if tables.n_outcomes != 1:
        raise InputError("depth-first search needs a deterministic world; use tree_search for a random one")
    if not 0 <= start < tables.n_states:
        raise InputError(f"start must lie in [0, {tables.n_states}), got {start}")
    shape = (tables.n_states, tables.n_actions)
    if preferred.order.shape != shape:
        raise InputError(f"preferred must have an order of shape {shape}, got {preferred.order.shape}")


@kernel
def _descend(next_state, event, order, n_tried, start, path):
    n_states = len(path)
    entered = np.zeros(n_states, np.bool_)
    states, at = np.empty(n_states, np.int64), np.zeros(n_states, np.int64)
    states[0], entered[start] = start, True
    depth, expanded = 0, 1
    while depth >= 0:
        state = states[depth]
        if at[depth] == n_tried[state]:
            depth -= 1
            continue
        action = order[state, at[depth]]
        at[depth] += 1
        path[depth] = action
        if event[state, action, 0] & TERMINAL:
            return True, expanded, depth + 1
        following = next_state[state, action, 0]
        if not entered[following]:
            entered[following] = True
            depth += 1
            states[depth], at[depth] = following, 0
            expanded += 1
    return False, expanded, 0
