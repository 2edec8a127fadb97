"""Exact solutions: closed forms, a dense linear-algebra twin, cycles and standing still."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.core.mdp import COLLISION, NOTHING, TERMINAL, Tables
from lifelore.core.planning.planning import (
    best_actions,
    greedy_policy,
    learnt_best_actions,
    optimal_actions,
    optimal_q,
    policy_values,
)

seeds = st.integers(0, 10**6)


def dense(tables: Tables) -> tuple[np.ndarray, np.ndarray]:
    """Mean rewards (n_states, n_actions) and transition matrices (n_actions, n_states, n_states)."""
    probs = np.diff(tables.outcome_cum, prepend=0.0)
    transitions = np.zeros((tables.n_actions, tables.n_states, tables.n_states))
    for s, a, k in np.ndindex(tables.next_state.shape):
        if not tables.event[s, a, k] & TERMINAL:
            transitions[a, s, tables.next_state[s, a, k]] += probs[k]
    return tables.reward @ probs, transitions


def ring(n=4) -> Tables:
    """Action 0 walks the ring for a reward of 1 each; action 1 stays and ends with 5."""
    here = np.arange(n)
    next_state = np.stack([(here + 1) % n, here], axis=1)[:, :, None].astype(np.int32)
    reward = np.tile([[1.0], [5.0]], (n, 1, 1))
    event = np.tile(np.array([[NOTHING], [TERMINAL]], np.uint8), (n, 1, 1))
    return Tables(next_state, reward, event, np.ones(1), np.array([0, 2], np.int32))


def test_a_policy_on_a_cycle_and_into_it():
    # 0 ends (5), 1 stands still, 2 → 3 → 0: 1 + ½(1 + ½·5).
    assert policy_values(ring(), np.array([1, -1, 0, 0]), 0.5).tolist() == [5.0, 0.0, 2.75, 3.5]
    assert policy_values(ring(), np.zeros(4, int), 0.9) == pytest.approx(np.full(4, 10.0))
    assert policy_values(ring(), np.full(4, -1), 0.9).tolist() == [0.0] * 4
    # A tail into a cycle: refused moves at the end of a row cost 1 for ever, 1 / (1 - ½) = 2.
    row = Tables(
        np.array([1, 2, 2], np.int32)[:, None, None],
        np.array([0.0, 0.0, -1.0])[:, None, None],
        np.array([NOTHING, NOTHING, COLLISION], np.uint8)[:, None, None],
        np.ones(1),
        np.zeros(1, np.int32),
    )
    assert policy_values(row, np.zeros(3, int), 0.5).tolist() == [-0.5, -1.0, -2.0]


@pytest.mark.parametrize(("discount", "message"), [(1.2, r"lie in \[0, 1\], got 1.2"), (np.nan, "got nan")])
def test_a_discount_out_of_range_is_refused(discount, message):
    with pytest.raises(InputError, match=message):
        optimal_q(ring(), discount)
    with pytest.raises(InputError, match=r"discount must lie in \[0, 1\)"):
        policy_values(ring(), np.zeros(4, int), discount)


@pytest.mark.parametrize("q", [[1.0, 2.0], [[]], [[np.nan, 1.0]], [[0.0, 1.0], [np.nan, np.nan]]])
def test_values_that_are_no_table_or_hold_nan_are_refused(q):
    for read in (best_actions, learnt_best_actions, greedy_policy):
        with pytest.raises(InputError, match=r"q must be values \(n_rows, n_actions\) without NaN"):
            read(q)


@pytest.mark.parametrize("policy", [[0, 0, 0], [0, 0, 0, 2], [0, 0, 0, -2], [0.5, 0, 0, 0], [0, 0, 0, 0, 0]])
def test_a_policy_that_names_no_action_for_each_state_is_refused(policy):
    with pytest.raises(InputError, match="policy must give each of 4 states an action, 0 to 1, or -1"):
        policy_values(ring(), np.array(policy), 0.9)  # pyright: ignore[reportArgumentType]


def test_without_discount_values_of_a_slow_walk_settle():
    """A drunkard's walk: from the closed end of n places, n (n − 1) steps to the open one."""
    n = 120
    walk = np.zeros((n, n))
    walk[np.arange(n - 1), np.maximum(np.arange(n - 1) - 1, 0)] = 0.5
    walk[np.arange(n - 1), np.arange(1, n)] += 0.5
    tables = Tables.from_matrices(walk[:, None], -np.ones((n, 1)), terminal=n - 1)
    assert optimal_q(tables, 1.0)[0, 0] == pytest.approx(-n * (n - 1), rel=1e-9)


def test_without_discount_values_that_grow_for_ever_are_refused():
    with pytest.raises(InputError, match="discount must be below 1 in this task"):
        optimal_q(ring(), 1.0)
    ended = np.array([[[0, 1.0], [0, 1.0]], [[1.0, 0], [1.0, 0]]])
    assert optimal_q(Tables.from_matrices(ended, -np.ones((2, 2)), terminal=1), 1.0)[0].tolist() == [-1.0, -1.0]


@settings(max_examples=40, deadline=None)
@given(seeds, st.sampled_from([1, 3]), st.sampled_from([0.0, 0.5, 0.95]))
def test_policy_values_solve_the_linear_equations(draw_world, seed, n_outcomes, discount):
    tables = draw_world(seed, n_states=9, n_outcomes=n_outcomes)
    policy = np.random.default_rng(seed).integers(-1, tables.n_actions, 9)
    reward, transitions = dense(tables)
    moves = policy >= 0
    chosen = np.where(moves, reward[np.arange(9), policy], 0.0)
    matrix = np.where(moves[:, None], transitions[policy, np.arange(9)], 0.0)
    exact = np.linalg.solve(np.eye(9) - discount * matrix, chosen)
    # Sweeps stop when nothing moves by 2e-12, so the rest is at most 2e-12 / (1 - 0.95).
    assert policy_values(tables, policy, discount) == pytest.approx(exact, abs=1e-10)


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(seeds, st.sampled_from([1, 3]), st.sampled_from([0.0, 0.5, 0.95]))
def test_value_iteration_same_as_dense_sweeps(draw_world, seed, n_outcomes, discount):
    tables = draw_world(seed, n_outcomes=n_outcomes)
    reward, transitions = dense(tables)
    q = np.zeros_like(reward)
    for _ in range(600):  # 0.95^600 · 40 = 2e-12
        q = reward + discount * np.einsum("ast,t->sa", transitions, q.max(axis=1))
    found = optimal_q(tables, discount)
    assert found == pytest.approx(q, abs=1e-10)
    # No policy beats it, and its own greedy policy attains it.
    assert policy_values(tables, found.argmax(axis=1), discount) == pytest.approx(found.max(axis=1), abs=1e-9)
    other = np.random.default_rng(seed).integers(0, tables.n_actions, tables.n_states)
    assert (policy_values(tables, other, discount) <= found.max(axis=1) + 1e-9).all()


def test_ties_within_the_tolerance_are_best():
    q = np.array([[1.0, 1.0 - 1e-12, 0.5], [0.0, 0.0, -1e-9], [-2.0, -2.0 * (1 + 1e-12), -3.0]])
    assert best_actions(q).tolist() == [[True, True, False]] * 3
    assert best_actions(q, 0.6)[0].tolist() == [True, True, True]


def test_ties_at_nothing_are_ties_whatever_the_rounding():
    q = np.array([[0.0, 3e-15, -2e-14], [0.0, 1e-6, 0.0], [100.0, 50.0, 0.0], [-np.inf, 0.0, 1e-11]])
    assert best_actions(q).tolist() == [
        [True, True, True], [False, True, False], [True, False, False], [False, True, True]
    ]  # fmt: skip
    # As large a share of smaller values is seen, and without a floor the rounding is.
    assert best_actions(q / 1e9).tolist() == best_actions(q).tolist()
    assert best_actions(q, floor=0.0)[0].tolist() == [False, True, False]
    assert best_actions(np.full((1, 2), -np.inf)).tolist() == [[True, True]]
    # What is learnt last, far from the goal, is little and yet learnt.
    assert learnt_best_actions(q)[0].tolist() == [False, True, False]


def test_learnt_costs_teach_and_nothing_learnt_does_not():
    q = np.array([[-3.0, -2.5, -4.0], [-3.0, 0.0, -4.0], [0.0, 0.0, 0.0], [2.0, -1.0, 0.0]])
    best = [[False, True, False], [False] * 3, [False] * 3, [True, False, False]]
    assert learnt_best_actions(q).tolist() == best


def test_optimal_actions_leave_out_where_no_episode_acts():
    # 0 → 1 → 2 (the goal; bumping there leads back to it); 3 leads to 0 and is never entered.
    next_state = np.array([[1, 0], [2, 0], [2, 2], [0, 0]], np.int32)[:, :, None]
    event = np.zeros(next_state.shape, np.uint8)
    event[1, 0] = TERMINAL
    tables = Tables(next_state, event.astype(float), event, np.ones(1), np.zeros(1, np.int32))
    assert optimal_actions(tables, 0.9).tolist() == [[True, False], [True, False], [False] * 2, [False] * 2]
    everywhere = tables._replace(starts=np.array([0, 3], np.int32))
    assert optimal_actions(everywhere, 0.9)[3].tolist() == [True, True]
