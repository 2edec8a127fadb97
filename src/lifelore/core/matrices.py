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

ROW_TOLERANCE = 1e-5
"""Largest distance from 1 of the sum of a row; float32 rounds by less. Its last outcome takes the rest."""

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


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
    n_states, n_actions, chances = _matrix(transitions, "transitions")
    ended = np.zeros(n_states, bool)
    ended[checked_numbers(terminal, n_states, "terminal")] = True
    chances.data[ended[_moves(chances, n_actions)[0]]] = 0
    chances.eliminate_zeros()
    _check_chances(chances, n_actions, ended)
    last = np.flatnonzero(np.repeat(ended, n_actions))
    chances += sparse.csr_array((np.ones(len(last)), (last, last // n_actions)), chances.shape)
    paid = np.where(ended[_moves(chances, n_actions)[0]], 0.0, _paid(rewards, chances, n_states, n_actions))
    count = np.diff(chances.indptr)[:, None]
    numbers = np.arange(count.max())
    place = (chances.indptr[:-1, None] + np.minimum(numbers, count - 1)).reshape(n_states, n_actions, -1)
    cumulative = np.cumsum(np.where(numbers < count, chances.data[place.reshape(len(count), -1)], 0.0), axis=1)
    np.minimum(cumulative, 1.0, out=cumulative)
    cumulative[numbers >= count - 1] = 1.0
    return Outcomes(chances.indices[place].astype(np.int32), paid[place], cumulative.reshape(place.shape)), ended


def outcomes_of_moves(moves: Any) -> tuple[Outcomes, NDArray[np.bool_]]:
    """Outcomes of Gymnasium's ``env.unwrapped.P``, and which end an episode, (n_states, n_actions, n_outcomes)."""
    try:
        rows = [[[*moves[s][a]] for a in range(len(moves[0]))] for s in range(len(moves))]
        most = max(len(row) for actions in rows for row in actions)
        filled = [[row + [(0, *row[-1][1:])] * (most - len(row)) for row in actions] for actions in rows]
        table = np.array(filled, float)
        chance, following, reward, ended = np.moveaxis(table, -1, 0)
    except (IndexError, KeyError, TypeError, ValueError):
        raise InputError(
            "transitions without rewards must be Gymnasium's env.unwrapped.P: "
            "{state: {action: [(probability, next state, reward, ended)]}}, numbered from 0"
        ) from None
    return Outcomes(following.astype(np.int32), reward, chance.cumsum(-1)), ended.astype(bool)


def checked_numbers(given: Any, n: int, name: str) -> Ints:
    """Numbers of states or actions below `n`, (m,), from numbers or from a mask (n,) bool.

    Raises
    ------
    InputError
        The mask has another length, or a number is not whole or not below `n`.
    """
    numbers = np.atleast_1d(np.asarray(sorted(given) if isinstance(given, set | frozenset) else given))
    if numbers.dtype == bool:
        if numbers.shape != (n,):
            raise InputError(f"{name} as a mask must have shape ({n},), got {numbers.shape}")
        return np.flatnonzero(numbers)
    if not numbers.size:
        return np.empty(0, np.int64)
    if numbers.ndim != 1 or numbers.dtype.kind not in "iu" or numbers.min() < 0 or numbers.max() >= n:
        raise InputError(f"{name} must be whole numbers from 0 to {n - 1}, got {given!r:.80}")
    if numbers.size == n > 2 and numbers.max() <= 1:
        raise InputError(f"{name} as a mask must hold booleans, got numbers 0 and 1; give astype(bool)")
    return numbers.astype(np.int64)


def dense_transitions(tables: "Tables") -> Floats:
    """T(s, a, s') of a task, (n_states, n_actions, n_states); rows sum to 1."""
    probability = np.diff(tables.by_pair.outcome_cum, axis=2, prepend=0.0)
    dense = np.zeros((tables.n_states, tables.n_actions, tables.n_states))
    state, action = np.ogrid[: tables.n_states, : tables.n_actions]
    np.add.at(dense, (state[..., None], action[..., None], tables.next_state), probability)
    return dense


def _matrix(given: Any, name: str, least: tuple[int, int] = (1, 1)) -> tuple[int, int, Any]:
    """Number of states and actions (of dictionaries at least `least`), and all numbers that are not 0.

    The last is a sparse matrix (n_states · n_actions, n_states), with next states in ascending order.
    """
    if isinstance(given, Mapping):
        n_states, n_actions, matrix = _of_dictionaries(given, name, least)
    elif isinstance(given, list | tuple) and given and all(sparse.issparse(matrix) for matrix in given):
        n_states, n_actions = given[0].shape[0], len(given)
        if {matrix.shape for matrix in given} != {(n_states, n_states)}:
            shapes = sorted({matrix.shape for matrix in given})
            raise InputError(f"{name} must hold one square matrix an action, all of one size, got shapes {shapes}")
        by_state = np.arange(n_states * n_actions).reshape(n_actions, n_states).T.ravel()
        matrix = sparse.csr_array(sparse.vstack(given, "csr", float))[by_state]
    else:
        try:
            dense: Any = np.asarray(given, np.float64)
        except (TypeError, ValueError):
            dense = np.empty(0)
        if dense.ndim != 3 or not dense.size or dense.shape[0] != dense.shape[2]:
            raise InputError(
                f"{name} must be an array (n_states, n_actions, n_states), a list of one sparse matrix "
                "(n_states, n_states) an action, or dictionaries {state: {action: {next state: number}}}; "
                f"got {type(given).__name__} of shape {dense.shape}. Transpose an array whose first axis is "
                "the action"
            )
        n_states, n_actions, _ = dense.shape
        matrix = sparse.csr_array(dense.reshape(-1, n_states))
    matrix.sum_duplicates()
    matrix.eliminate_zeros()
    return n_states, n_actions, matrix


def _of_dictionaries(rows: Mapping, name: str, least: tuple[int, int]) -> tuple[int, int, Any]:
    try:
        entries = [
            (s, a, s2, float(number))
            for s, actions in rows.items()
            for a, row in actions.items()
            for s2, number in row.items()
        ]
        table: Any = np.array([entry[:3] for entry in entries]).reshape(-1, 3)
        states = np.array([*rows, *table[:, 2].tolist()])
        if not (table.dtype.kind == states.dtype.kind == "i" and min(states.min(), table.min()) >= 0):
            raise TypeError
    except (AttributeError, TypeError, ValueError):
        raise InputError(
            f"{name} as dictionaries must be {{state: {{action: {{next state: number}}}}}} numbered from 0, "
            f"got {rows!r:.80}"
        ) from None
    n_states, n_actions = max(int(states.max()) + 1, least[0]), max(int(table[:, 1].max()) + 1, least[1])
    places = (table[:, 0] * n_actions + table[:, 1], table[:, 2])
    numbers = [entry[3] for entry in entries]
    return n_states, n_actions, sparse.csr_array((numbers, places), (n_states * n_actions, n_states))


def _moves(matrix: Any, n_actions: int) -> tuple[Ints, Ints, Ints]:
    """State, action and next state of each number, all (n_moves,)."""
    rows = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
    return rows // n_actions, rows % n_actions, matrix.indices


def _check_chances(chances: Any, n_actions: int, ended: NDArray[np.bool_]) -> None:
    """Numbers must be probabilities, and sum to 1 for each action of a state that is not terminal."""
    wrong = np.flatnonzero(~((chances.data > 0) & (chances.data <= 1 + ROW_TOLERANCE)))
    if wrong.size:
        s, a, s2 = (part[wrong[0]] for part in _moves(chances, n_actions))
        raise InputError(
            f"transitions must be probabilities in [0, 1], got {chances.data[wrong[0]]} for T({s}, {a}, {s2})"
        )
    total = np.where(ended[:, None], 1.0, chances.sum(axis=1).reshape(-1, n_actions))
    if not np.allclose(total, 1, rtol=0, atol=ROW_TOLERANCE):
        s, a = np.unravel_index(np.abs(total - 1).argmax(), total.shape)
        raise InputError(
            f"transitions must sum to 1 over the next states, got {total[s, a]:g} for state {s}, action {a}; "
            "name a state in terminal= if no action is taken there"
        )


def _paid(rewards: Any, chances: Any, n_states: int, n_actions: int) -> Floats:
    """The reward of each move, (n_moves,)."""
    state, action, following = _moves(chances, n_actions)
    if isinstance(rewards, Mapping) or (
        isinstance(rewards, list | tuple) and rewards and sparse.issparse(rewards[0])
    ):
        of_states, of_actions, given = _matrix(rewards, "rewards", (n_states, n_actions))
        if (of_states, of_actions) != (n_states, n_actions):
            raise InputError(
                f"rewards must be of {n_states} states and {n_actions} actions, as transitions are, got "
                f"{of_states} and {of_actions}"
            )
        paid = np.asarray(sparse.csr_matrix(given)[state * n_actions + action, following]).ravel()
    else:
        given: Any = np.asarray(rewards)
        given = given.astype(float) if given.dtype.kind in "biuf" else np.empty(0)
        places: dict[tuple[int, ...], Any] = {
            (n_states,): following,
            (n_states, n_actions): (state, action),
            (n_states, n_actions, n_states): (state, action, following),
        }
        if given.shape not in places:
            raise InputError(
                f"rewards must have shape ({n_states},), ({n_states}, {n_actions}) or "
                f"({n_states}, {n_actions}, {n_states}), got {np.shape(rewards)}"
            )
        paid = given[places[given.shape]]
    if not np.isfinite(paid).all():
        at = np.flatnonzero(~np.isfinite(paid))[0]
        s, a, s2 = state[at], action[at], following[at]
        raise InputError(f"rewards must be finite, got {paid[at]} for R({s}, {a}, {s2})")
    return paid
