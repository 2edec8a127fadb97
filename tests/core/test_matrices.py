"""MDPs from matrices: all forms give one task, solved as by a plain loop; each broken rule has its sentence."""

from typing import Any

import gymnasium
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse

from lifelore.core.errors import InputError
from lifelore.core.matrices import dense_transitions
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.planning.planning import optimal_actions, optimal_q

GAMMA = 0.9


def random_mdp(seed: int, n_states: int = 7, n_actions: int = 3, share: float = 0.5):
    """T with about `share` of its entries above 0, and rewards of moves."""
    random = np.random.default_rng(seed)
    weight = random.random((n_states, n_actions, n_states)) * (
        random.random((n_states, n_actions, n_states)) < share
    )
    weight[..., 0] += weight.sum(axis=2) == 0
    return weight / weight.sum(axis=2, keepdims=True), random.normal(size=weight.shape)


def naive_q(transitions, rewards, terminal) -> np.ndarray:
    """Value iteration as a textbook has it, by sums over all states."""
    n_states, n_actions, _ = transitions.shape
    q = np.zeros((n_states, n_actions))
    for _ in range(400):
        value = [0.0 if s in terminal else q[s].max() for s in range(n_states)]
        q = np.array(
            [
                [
                    0.0 if s in terminal
                    else sum(
                        transitions[s, a, t] * (rewards[s, a, t] + GAMMA * value[t]) for t in range(n_states)
                    )
                    for a in range(n_actions)
                ]
                for s in range(n_states)
            ]
        )  # fmt: skip
    return q


def as_dictionaries(array: np.ndarray) -> dict:
    return {
        s: {a: {t: float(p) for t, p in enumerate(row) if p} for a, row in enumerate(actions)}
        for s, actions in enumerate(array)
    }


def as_sparse(array: np.ndarray, form=sparse.csr_matrix) -> list:
    return [form(array[:, a]) for a in range(array.shape[1])]


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([0.2, 1.0]), st.sets(st.integers(0, 6), max_size=3))
def test_optimal_values_are_those_of_a_plain_loop(seed, share, terminal):
    transitions, rewards = random_mdp(seed, share=share)
    tables = Tables.from_matrices(transitions, rewards, terminal=sorted(terminal))
    assert optimal_q(tables, GAMMA) == pytest.approx(naive_q(transitions, rewards, terminal), abs=1e-9)


@pytest.mark.parametrize("form", [sparse.csr_matrix, sparse.coo_array, sparse.csc_array, as_dictionaries])
def test_all_forms_give_the_same_tables(form):
    transitions, rewards = random_mdp(3)
    dense = Tables.from_matrices(transitions, rewards, terminal=[2])
    if form is as_dictionaries:
        other = Tables.from_matrices(as_dictionaries(transitions), as_dictionaries(rewards), [2])
    else:
        other = Tables.from_matrices(as_sparse(transitions, form), as_sparse(rewards, form), [2])
    for one, two in zip(dense, other, strict=True):
        assert np.array_equal(one, two)


def test_rounding_of_float32_is_no_mistake():
    transitions, rewards = random_mdp(3)
    rounded = Tables.from_matrices(transitions.astype(np.float32), rewards, terminal={2})
    exact = Tables.from_matrices(transitions, rewards, terminal={2})
    assert optimal_q(rounded, GAMMA) == pytest.approx(optimal_q(exact, GAMMA), abs=1e-5)
    over = Tables.from_matrices([[[0.999995, 0.000009, 1e-7]]] * 3, [0, 0, 0])
    assert dense_transitions(over).min() >= 0


def test_rewards_of_actions_and_of_states():
    transitions, _ = random_mdp(5)
    of_actions, of_states = np.random.default_rng(0).normal(size=(7, 3)), np.arange(7.0)
    for given_, full in (
        (of_actions, np.broadcast_to(of_actions[..., None], (7, 3, 7))),
        (of_states, np.broadcast_to(of_states, (7, 3, 7))),
    ):
        short, long = (Tables.from_matrices(transitions, rewards, [6]) for rewards in (given_, full))
        assert np.array_equal(short.reward, long.reward)


def test_by_hand():
    # From 0, action 0 wins 10 with ½ and else stays; action 1 stays. Q(0, 0) = ½·10 + ½·γ·Q(0, 0) = 5 / (1 - γ/2).
    tables = Tables.from_matrices([[[0.5, 0.5], [1, 0]], [[0, 0], [0, 0]]], [0, 10.0], terminal=1)
    q = optimal_q(tables, GAMMA)
    assert q[0] == pytest.approx([5 / 0.55, GAMMA * 5 / 0.55])
    assert q[1].tolist() == [0.0, 0.0]
    assert tables.starts.tolist() == [0]
    assert (tables.event & TERMINAL).tolist() == [[[0, 1], [0, 0]], [[1, 1], [1, 1]]]
    assert optimal_actions(tables, GAMMA).tolist() == [[True, False], [False, False]]


@pytest.mark.parametrize(
    ("world", "options"),
    [("FrozenLake-v1", {}), ("CliffWalking-v1", {"is_slippery": True}), ("Taxi-v4", {"is_rainy": True})],
)
def test_transitions_of_a_toy_world_of_gymnasium(world, options):
    """Moves of the slippery cliff lead to one cell with two rewards; Taxi ends by a move, not by a state."""
    env: Any = gymnasium.make(world, **options).unwrapped
    moves, discount = env.P, 0.9
    tables = Tables.from_matrices(moves, starts=np.flatnonzero(env.initial_state_distrib))
    value, q = np.zeros(len(moves)), np.zeros((len(moves), len(moves[0])))
    for _ in range(150):
        for s, a in np.ndindex(q.shape):
            q[s, a] = sum(p * (r + discount * (not end) * value[t]) for p, t, r, end in moves[s][a])
        value = q.max(axis=1)
    # 150 sweeps leave 0.9 ** 150 of the first error, which is at most 100 / (1 - 0.9).
    assert np.abs(optimal_q(tables, discount) - q).max() < 1e-3


@pytest.mark.parametrize("moves", [{}, np.eye(2), {0: {0: []}}, {0: {0: {0: 1.0}}}, {1: {0: [(1.0, 1, 0, True)]}}])
def test_transitions_without_rewards_are_those_of_gymnasium(moves):
    with pytest.raises(InputError, match="transitions without rewards must be Gymnasium's"):
        Tables.from_matrices(moves)


def test_a_world_of_gymnasium_takes_more_terminal_states():
    moves = {s: {0: [(0.5, s, -1.0, False), (0.5, (s + 1) % 3, 2.0, s == 1)]} for s in range(3)}
    tables = Tables.from_matrices(moves, terminal=[0])
    assert tables.event[:, 0].tolist() == [[TERMINAL, 0], [0, TERMINAL], [0, TERMINAL]]
    assert tables.starts.tolist() == [1]
    with pytest.raises(InputError, match="outcome_cum must rise to 1"):
        optimal_q(Tables.from_matrices({0: {0: [(0.5, 1, 0.0, False)]}, 1: {0: [(1.0, 1, 0.0, True)]}}), GAMMA)


def test_memory_grows_with_the_next_states_of_a_move():
    n_states = 20_000  # T itself would be 6.4 GB
    ahead = sparse.csr_array(
        (np.ones(n_states), (np.arange(n_states), np.minimum(np.arange(n_states) + 1, n_states - 1)))
    )
    back = 0.5 * sparse.eye_array(n_states) + 0.5 * ahead
    tables = Tables.from_matrices([ahead, back], np.eye(1, n_states, n_states - 1)[0], terminal=[n_states - 1])
    assert sum(part.nbytes for part in tables) < 2e6
    assert optimal_actions(tables, GAMMA)[-101:].tolist() == [[True, False]] * 100 + [[False, False]]


T, R = random_mdp(0)
BAD = T.copy()
BAD[2, 1] *= 0.5
NEGATIVE = T.copy()
NEGATIVE[4, 0, :2] = [-0.5, 1.5]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((T[0], R), r"transitions must be an array \(n_states, n_actions, n_states\), a list of one sparse"),
        ((T[:, :, :5], R), "transitions must be an array .* got ndarray of shape"),
        ((BAD, R), "sum to 1 over the next states, got 0.5 for state 2, action 1; name a state in terminal="),
        ((NEGATIVE, R), r"must be probabilities in \[0, 1\], got -0.5 for T\(4, 0, 0\)"),
        ((np.full_like(T, np.nan), R), "must be probabilities in .*nan"),
        ((T, R[0]), r"rewards must have shape \(7,\), \(7, 3\) or \(7, 3, 7\), got \(3, 7\)"),
        ((T, np.full(7, np.inf)), "rewards must be finite, got inf for R"),
        ((T, R, [7]), r"terminal must be whole numbers from 0 to 6, got \[7\]"),
        ((T, R, [0.5]), "terminal must be whole numbers"),
        ((T, R, [0, 0, 1, 0, 0, 0, 0]), "terminal as a mask must hold booleans"),
        ((T, R, [True]), r"terminal as a mask must have shape \(7,\)"),
        ((T, R, [1], [1, 2]), r"starts must name at least one state, none of them terminal, got \[1\]"),
        ((T, R, range(7)), "starts must name at least one state, got none"),
        ((as_sparse(T)[:2] + as_sparse(T[:5, :, :5])[:1], R), "one square matrix an action, all of one size"),
        ((as_sparse(T), as_sparse(T)[:2]), "rewards must be of 7 states and 3 actions"),
        (({"a": {0: {0: 1.0}}}, R), "transitions as dictionaries must be"),
        (({0: {0: 1.0}}, [0.0]), "transitions as dictionaries must be"),
        (({0: {0: {1: 1.0}}}, [0.0, 1.0]), "got 0 for state 1, action 0; name a state in terminal="),
        (({0: {0: {0: 1.0}}}, {0: {0: {5: 1.0}}}), "rewards must be of 1 states and 1 actions"),
    ],
)
def test_broken_rules(arguments, message):
    with pytest.raises(InputError, match=message):
        Tables.from_matrices(*arguments)
