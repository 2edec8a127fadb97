"""Exact solutions on tables: values, all tied-optimal actions, and the value of a given policy."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.core.errors import InputError
from lifelore.core.mdp import TERMINAL, Tables

TIE_TOLERANCE = 1e-9
"""Actions whose values differ by no more than this, relative to the row's best, are tied."""
TIE_FLOOR = 1e-12
"""Also tied are values that differ by less than this, relative to the largest value: rounding is no better."""
SWEEPS = 50_000
"""Sweeps between two looks at how much values still move."""
STEADY = 0.99
"""Values without discount grow for ever that still move this share of what they moved `SWEEPS` sweeps before."""


def optimal_q(tables: Tables, discount: float) -> NDArray[np.float64]:
    """Optimal action values by value iteration, (n_states, n_actions).

    Sweeps in place until no value moves by more than 10⁻¹² of the largest reward. Where every
    reward but a terminal one is zero or a loss, values settle exactly after as many sweeps as the longest
    shortest path.

    Raises
    ------
    InputError
        `discount` lies outside [0, 1]; or it is 1, and the values grow for ever.

    Examples
    --------
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; actions left and right
    >>> optimal_q(Tables.from_matrices(T, [0.0, 0.0, 1.0], terminal=2), 0.9).round(2).tolist()
    [[0.81, 0.9], [0.81, 1.0], [0.0, 0.0]]
    """
    if not 0 <= discount <= 1:
        raise InputError(f"discount must lie in [0, 1], got {discount}")
    rows = tables.checked().by_pair
    tolerance = 1e-12 * max(1.0, float(np.abs(tables.reward).max()))
    q, value = np.zeros(tables.next_state.shape[:2]), np.zeros(tables.n_states)
    moved = np.inf
    while True:
        before, moved = moved, _sweep(rows, float(discount), tolerance, q, value)
        # Large values are rounded by more than the tolerance.
        if not moved > max(tolerance, 2 * np.finfo(np.float64).eps * float(np.abs(value).max())):
            return q
        if discount == 1 and moved > STEADY * before:
            raise InputError(
                "discount must be below 1 in this task: its values grow for ever, because some state never reaches"
                " a terminal one without an endless loss, or moves in a circle pay"
            )


@kernel
def _sweep(tables, discount, tolerance, q, value):
    n_states, n_actions = q.shape
    moved, sweeps = tolerance + 1.0, 0
    while moved > tolerance and sweeps < SWEEPS:
        moved, forwards = 0.0, sweeps % 2 == 0
        sweeps += 1
        for i in range(n_states):
            s = i if forwards else n_states - 1 - i
            best = q[s, 0] = backup(tables, s, 0, discount, value)
            for a in range(1, n_actions):
                q[s, a] = backup(tables, s, a, discount, value)
                if q[s, a] > best:
                    best = q[s, a]
            if abs(best - value[s]) > moved:
                moved = abs(best - value[s])
            value[s] = best
    return moved


@inlined
def backup(tables, s, a, discount, value):
    """Expected reward and discounted value of what follows (the Bellman backup); `tables` are `Tables.by_pair`."""
    next_state, reward, event, outcome_cum, _ = tables
    total, before = 0.0, 0.0
    for k in range(next_state.shape[2]):
        gain = reward[s, a, k]
        if not event[s, a, k] & TERMINAL:
            gain += discount * value[next_state[s, a, k]]
        total += (outcome_cum[s, a, k] - before) * gain
        before = outcome_cum[s, a, k]
    return total


def best_actions(q: ArrayLike, tolerance: float = TIE_TOLERANCE, floor: float = TIE_FLOOR) -> NDArray[np.bool_]:
    """Which actions are best or tied best in each row (Eq. 3.1), (n_rows, n_actions) bool.

    Tied are values within `tolerance` · |the row's best| or `floor` · |the largest finite value of all rows|,
    whichever is more: where the best value is 0, rounding must not choose. An infinite value marks an action that
    does not exist.

    Raises
    ------
    InputError
        `q` is no table of values, or holds NaN.

    Examples
    --------
    >>> best_actions(np.array([[1.0, 1.0, 0.0], [0.0, 2.0, 1.0]])).tolist()
    [[True, True, False], [False, True, False]]
    """
    q, best = _with_best(q)
    largest = np.abs(q).max(where=np.isfinite(q), initial=0.0)
    return q >= best - np.maximum(tolerance * np.abs(best), floor * largest)


def _with_best(q: ArrayLike) -> tuple[NDArray[Any], NDArray[Any]]:
    """Values as an array, and the best of each row, (n_rows, 1); InputError for another shape or NaN."""
    q = np.asarray(q)
    if q.ndim != 2 or not q.shape[1] or np.isnan(best := q.max(axis=1, keepdims=True)).any():
        raise InputError(f"q must be values (n_rows, n_actions) without NaN, got {q.dtype} of shape {q.shape}")
    return q, best


def checked_best(best: ArrayLike) -> NDArray[np.bool_]:
    """Best or tied-best actions as they are; InputError where they are not boolean, as Q and π are not."""
    given = np.asarray(best)
    if given.dtype != bool and given.size:
        raise InputError(
            f"best must be boolean, True where an action is best or tied best, got {given.dtype}: "
            "apply best_actions to values Q or probabilities π first, or count π by ActionPrior.update_policy"
        )
    return given.astype(bool, copy=False)


def optimal_actions(tables: Tables, discount: float) -> NDArray[np.bool_]:
    """The best or tied-best actions of the optimal policies, (n_states, n_actions) bool, for `ActionPrior.update`.

    Rows in which no episode takes an action, such as the goal's, are all False (errata E3).

    Examples
    --------
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; actions left and right
    >>> optimal_actions(Tables.from_matrices(T, [0.0, 0.0, 1.0], terminal=2), 0.9).tolist()
    [[False, True], [False, True], [False, False]]
    """
    follow, going = tables.next_state, (tables.event & TERMINAL) == 0
    acting = states_from(tables.starts, tables.n_states, lambda states: follow[states][going[states]])
    return best_actions(optimal_q(tables, discount)) & acting[:, None]


def states_from(
    starts: ArrayLike, n_states: int, entered: Callable[[NDArray[np.int64]], NDArray[Any]]
) -> NDArray[np.bool_]:
    """Which states are reached from `starts`, (n_states,); `entered` gives the next states of some states."""
    reached, frontier = np.zeros(n_states, bool), np.unique(starts)
    while frontier.size:
        reached[frontier] = True
        found = np.unique(entered(frontier))
        frontier = found[~reached[found]]
    return reached


def learnt_best_actions(q: ArrayLike) -> NDArray[np.bool_]:
    """`best_actions` of a learned Q; rows whose best value is 0, as at the start, are all False: nothing learned.

    Where every move costs, an untried action has the best value of its row. A value just learned may be very
    small, so there is no floor.

    Examples
    --------
    >>> learnt_best_actions(np.array([[0.0, 2.0], [0.0, 0.0]])).tolist()
    [[False, True], [False, False]]
    """
    q, best = _with_best(q)
    return best_actions(q, floor=0.0) & (best != 0)


def greedy_policy(q: ArrayLike) -> NDArray[np.int32]:
    """The first best action of each state; -1 where no value is above zero.

    A learner without a value above zero in a state has no policy there yet. It counts as standing still, with
    value 0, for every learner alike.

    Examples
    --------
    >>> greedy_policy(np.array([[0.0, 2.0], [0.0, 0.0]])).tolist()
    [1, -1]
    """
    q, best = _with_best(q)
    return np.where(best[:, 0] > 0, q.argmax(axis=1), -1).astype(np.int32)


def policy_values(tables: Tables, policy: NDArray[np.int32], discount: float) -> NDArray[np.float64]:
    """Exact value of following `policy` from every state, (n_states,).

    Parameters
    ----------
    tables : Tables
    policy : (n_states,) int
        Action of each state; -1: stand still, value 0.
    discount : float
        γ in [0, 1).

    Raises
    ------
    InputError
        `discount` lies outside [0, 1), or `policy` is no action, or -1, for each state.

    Examples
    --------
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; actions left and right
    >>> tables = Tables.from_matrices(T, [0.0, 0.0, 1.0], terminal=2)
    >>> policy_values(tables, np.array([1, 1, -1], np.int32), 0.9).round(2).tolist()
    [0.9, 1.0, 0.0]
    """
    if not 0 <= discount < 1:
        raise InputError(f"discount must lie in [0, 1), got {discount}")
    given = np.asarray(policy)
    # An action out of range would read foreign memory inside the kernel.
    whole = given.shape == (tables.n_states,) and given.dtype.kind in "iu"
    if not (whole and given.min() >= -1 and given.max() < tables.n_actions):
        raise InputError(
            f"policy must give each of {tables.n_states} states an action, 0 to {tables.n_actions - 1}, or -1, "
            f"got {given.dtype} of shape {given.shape}: {policy!r:.60}"
        )
    policy, rows = np.ascontiguousarray(given, dtype=np.int32), tables.checked().by_pair
    if tables.n_outcomes == 1:
        return _follow(rows, policy, float(discount))
    return _iterate(rows, policy, float(discount), 1e-12 * max(1.0, float(np.abs(tables.reward).max())))


@kernel
def _follow(tables, policy, discount):
    """Deterministic world: walk each path once; a cycle's value has a closed form."""
    next_state, reward, event, _, _ = tables
    value, path = np.zeros(policy.size), np.empty(policy.size, np.int64)
    mark = np.zeros(policy.size, np.int64)  # 0 new, -1 done, else 1 + place on the path under way
    for start in range(policy.size):
        length, s = 0, start
        ended = False
        while not ended and mark[s] == 0:
            if policy[s] < 0:
                mark[s] = -1
                break
            path[length] = s
            length += 1
            mark[s] = length
            ended = event[s, policy[s], 0] & TERMINAL > 0
            s = next_state[s, policy[s], 0]
        after = 0.0 if ended else value[s]
        if not ended and mark[s] > 0:
            first = mark[s] - 1
            once, shrunk = 0.0, 1.0
            for i in range(length - 1, first - 1, -1):
                once = reward[path[i], policy[path[i]], 0] + discount * once
                shrunk *= discount
            after = once / (1.0 - shrunk)
        for i in range(length - 1, -1, -1):
            after = reward[path[i], policy[path[i]], 0] + discount * after
            value[path[i]] = after
            mark[path[i]] = -1
    return value


@kernel
def _iterate(tables, policy, discount, tolerance):
    value = np.zeros(policy.size)
    moved = tolerance + 1.0
    while moved > tolerance:
        moved = 0.0
        for s in range(policy.size):
            if policy[s] < 0:
                continue
            total = backup(tables, s, policy[s], discount, value)
            if abs(total - value[s]) > moved:
                moved = abs(total - value[s])
            value[s] = total
    return value


def mean_start_value(tables: Tables, values: NDArray[np.float64]) -> float:
    """A value function averaged over the initial states S₀.

    Examples
    --------
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; actions left and right
    >>> tables = Tables.from_matrices(T, [0.0, 0.0, 1.0], terminal=2, starts=[0, 1])
    >>> mean_start_value(tables, np.array([0.9, 1.0, 0.0]))
    0.95
    """
    return float(values[tables.starts].mean())
