"""Outcomes of an MDP's moves from transition matrices T(s, a, s') and rewards: dense, sparse or dictionaries.

A terminal state ends the episode when it is entered, so its own row is not read: it stays where it is, without
reward.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from lifelore.core.errors import InputError

if TYPE_CHECKING:
    from lifelore.core.mdp import Tables

ROW_TOLERANCE = 1e-9
"""Largest distance from 1 of the sum of a row of probabilities; a larger one is a mistake."""

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


class Moves(NamedTuple):
    """Moves (state, action, next state), sorted, with a number each; all (n_moves,)."""

    state: Ints
    action: Ints
    following: Ints
    number: Floats


class Outcomes(NamedTuple):
    """The outcomes of each move, all (n_states, n_actions, n_outcomes); unused ones have probability 0.

    following : int32, the next state
    reward : float64
    cumulative : float64, cumulative probabilities; the last is 1
    """

    following: NDArray[np.int32]
    reward: Floats
    cumulative: Floats


def outcomes_of(transitions: Any, rewards: Any, terminal: Any) -> tuple[Outcomes, NDArray[np.bool_]]:
    """Outcomes, and which states are terminal, (n_states,) bool; see `Tables.from_matrices` for the forms."""
    n_states, n_actions, given = _moves(transitions, "transitions")
    ended = np.zeros(n_states, bool)
    ended[checked_numbers(terminal, n_states, "terminal")] = True
    moves = _with_ends(_checked_moves(given, n_states, n_actions, ended), n_actions, ended)
    paid = np.where(ended[moves.state], 0.0, _paid(rewards, moves, n_states, n_actions))
    shape = (n_states, n_actions)
    first, count = _runs(moves.state * n_actions + moves.action, n_states * n_actions)
    n_outcomes = int(count.max())
    place = (first[:, None] + np.minimum(np.arange(n_outcomes), count[:, None] - 1)).reshape(*shape, n_outcomes)
    used = np.arange(n_outcomes) < count.reshape(*shape, 1)
    cumulative = np.cumsum(np.where(used, moves.number[place], 0.0), axis=2)
    cumulative[np.arange(n_outcomes) >= count.reshape(*shape, 1) - 1] = 1.0
    return Outcomes(moves.following[place].astype(np.int32), paid[place], cumulative), ended


def checked_numbers(given: Any, n: int, name: str) -> Ints:
    """Numbers of states or actions below `n`, (m,), from numbers or from a mask (n,) bool.

    Raises
    ------
    InputError
        The mask has another length, or a number is not whole or not below `n`.
    """
    numbers = np.atleast_1d(np.asarray(given))
    if numbers.dtype == bool:
        if numbers.shape != (n,):
            raise InputError(f"{name} as a mask must have shape ({n},), got {numbers.shape}")
        return np.flatnonzero(numbers)
    if not numbers.size:
        return np.empty(0, np.int64)
    if numbers.ndim != 1 or numbers.dtype.kind not in "iu" or numbers.min() < 0 or numbers.max() >= n:
        raise InputError(f"{name} must be whole numbers from 0 to {n - 1}, got {given!r:.80}")
    return numbers.astype(np.int64)


def dense_transitions(tables: "Tables") -> Floats:
    """T(s, a, s') of a task, (n_states, n_actions, n_states); rows sum to 1."""
    probability = np.diff(tables.by_pair.outcome_cum, axis=2, prepend=0.0)
    dense = np.zeros((tables.n_states, tables.n_actions, tables.n_states))
    state, action = np.ogrid[: tables.n_states, : tables.n_actions]
    np.add.at(dense, (state[..., None], action[..., None], tables.next_state), probability)
    return dense


def _moves(given: Any, name: str) -> tuple[int, int, Moves]:
    """Number of states and actions, and all entries that are not 0."""
    if isinstance(given, Mapping):
        return _of_dictionaries(given, name)
    if isinstance(given, list | tuple) and given and all(sparse.issparse(matrix) for matrix in given):
        return _of_sparse(given, name)
    try:
        dense: Any = np.asarray(given, np.float64)
    except (TypeError, ValueError):
        dense = np.empty(0)
    if dense.ndim != 3 or not dense.size or dense.shape[0] != dense.shape[2]:
        raise InputError(
            f"{name} must be an array (n_states, n_actions, n_states), a list of one sparse matrix "
            "(n_states, n_states) an action, or dictionaries {state: {action: {next state: number}}}; "
            f"got {type(given).__name__} of shape {dense.shape}. Transpose an array whose first axis is the action"
        )
    state, action, following = np.nonzero(dense)
    return dense.shape[0], dense.shape[1], Moves(state, action, following, dense[state, action, following])


def _of_sparse(matrices: Any, name: str) -> tuple[int, int, Moves]:
    n_states = matrices[0].shape[0]
    if {matrix.shape for matrix in matrices} != {(n_states, n_states)}:
        shapes = sorted({matrix.shape for matrix in matrices})
        raise InputError(f"{name} must hold one square matrix an action, all of one size, got shapes {shapes}")
    entries = [sparse.coo_array(sparse.csr_array(matrix)) for matrix in matrices]  # the sum of repeated entries
    action = np.repeat(np.arange(len(entries)), [entry.nnz for entry in entries])
    state, following, number = (
        np.concatenate([getattr(entry, part) for entry in entries]) for part in ("row", "col", "data")
    )
    return n_states, len(entries), _sorted(state, action, following, number)


def _of_dictionaries(rows: Mapping, name: str) -> tuple[int, int, Moves]:
    entries: Any
    try:
        entries = [
            (s, a, s2, float(number))
            for s, actions in rows.items()
            for a, row in actions.items()
            for s2, number in row.items()
        ]
        table: Any = np.array([entry[:3] for entry in entries]).reshape(-1, 3)
        states = np.array([*rows, *table[:, 2].tolist()])
        whole = table.dtype.kind == "i" and states.dtype.kind == "i" and states.min() >= 0 and table.min() >= 0
    except (AttributeError, TypeError, ValueError):
        whole, entries, table, states = False, [], np.empty((0, 3), int), np.empty(0, int)
    if not whole:
        raise InputError(
            f"{name} as dictionaries must be {{state: {{action: {{next state: number}}}}}} numbered from 0, "
            f"got {rows!r:.80}"
        )
    number = np.array([entry[3] for entry in entries])
    return (
        int(states.max()) + 1,
        int(table[:, 1].max()) + 1,
        _sorted(table[:, 0], table[:, 1], table[:, 2], number),
    )


def _sorted(state: Any, action: Any, following: Any, number: Any) -> Moves:
    order = np.lexsort((following, action, state))
    order = order[number[order] != 0]
    state, action, following = (part[order].astype(np.int64) for part in (state, action, following))
    return Moves(state, action, following, number[order].astype(float))


def _checked_moves(moves: Moves, n_states: int, n_actions: int, ended: NDArray[np.bool_]) -> Moves:
    """The moves of states that are not terminal, whose probabilities must sum to 1 for each action."""
    read = ~ended[moves.state]
    moves = Moves(moves.state[read], moves.action[read], moves.following[read], moves.number[read])
    wrong = np.flatnonzero(~((moves.number > 0) & (moves.number <= 1 + ROW_TOLERANCE)))
    if wrong.size:
        s, a, s2, number = (part[wrong[0]] for part in moves)
        raise InputError(f"transitions must be probabilities in [0, 1], got {number} for T({s}, {a}, {s2})")
    total = np.bincount(moves.state * n_actions + moves.action, moves.number, n_states * n_actions)
    total = np.where(ended[:, None], 1.0, total.reshape(n_states, n_actions))
    if not np.allclose(total, 1, rtol=0, atol=ROW_TOLERANCE):
        s, a = np.unravel_index(np.abs(total - 1).argmax(), total.shape)
        raise InputError(
            f"transitions must sum to 1 over the next states, got {total[s, a]:g} for state {s}, action {a}; "
            "name a state in terminal= if no action is taken there"
        )
    return moves


def _with_ends(moves: Moves, n_actions: int, ended: NDArray[np.bool_]) -> Moves:
    """The moves, and for each action of a terminal state one that stays."""
    state = np.repeat(np.flatnonzero(ended), n_actions)
    action = np.tile(np.arange(n_actions), int(ended.sum()))
    stays = (state, action, state, np.ones(len(state)))
    both: Any = [np.concatenate(pair) for pair in zip(moves, stays, strict=True)]
    return _sorted(*both)


def _runs(rows: Ints, n_rows: int) -> tuple[Ints, Ints]:
    """First place and number of the entries of each row in ascending row numbers."""
    count = np.bincount(rows, minlength=n_rows)
    return np.cumsum(count) - count, count


def _paid(rewards: Any, moves: Moves, n_states: int, n_actions: int) -> Floats:
    """The reward of each move, (n_moves,)."""
    sparse_list = isinstance(rewards, list | tuple) and bool(rewards) and sparse.issparse(rewards[0])
    if isinstance(rewards, Mapping) or sparse_list:
        of_states, of_actions, given = _moves(rewards, "rewards")
        if of_states > n_states or of_actions > n_actions or (sparse_list and of_actions != n_actions):
            raise InputError(
                f"rewards must be of {n_states} states and {n_actions} actions, as transitions are, got "
                f"{of_states} and {of_actions}"
            )
        paid = _looked_up(given, moves, n_states, n_actions)
    else:
        paid = _of_array(rewards, moves, n_states, n_actions)
    if not np.isfinite(paid).all():
        at = np.flatnonzero(~np.isfinite(paid))[0]
        s, a, s2, _ = (part[at] for part in moves)
        raise InputError(f"rewards must be finite, got {paid[at]} for R({s}, {a}, {s2})")
    return paid


def _of_array(rewards: Any, moves: Moves, n_states: int, n_actions: int) -> Floats:
    given: Any = np.asarray(rewards)
    given = given.astype(float) if given.dtype.kind in "biuf" else np.empty(0)
    if given.shape == (n_states,):
        return given[moves.following]
    if given.shape == (n_states, n_actions):
        return given[moves.state, moves.action]
    if given.shape == (n_states, n_actions, n_states):
        return given[moves.state, moves.action, moves.following]
    raise InputError(
        f"rewards must have shape ({n_states},), ({n_states}, {n_actions}) or "
        f"({n_states}, {n_actions}, {n_states}), got {np.shape(rewards)}"
    )


def _looked_up(given: Moves, moves: Moves, n_states: int, n_actions: int) -> Floats:
    """The numbers of `given` at the places of `moves`; 0 where it has none."""
    keys, wanted = ((m.state * n_actions + m.action) * n_states + m.following for m in (given, moves))
    if not len(keys):
        return np.zeros(len(wanted))
    at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return np.where(keys[at] == wanted, given.number[at], 0.0)
