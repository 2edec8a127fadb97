"""Domains and tasks: enumeration by hand, and the rules they hold to."""

import numpy as np
import pytest

from lifelore.core import (
    COLLISION,
    NOTHING,
    TERMINAL,
    Domain,
    InputError,
    QLearning,
    Tables,
    Task,
    optimal_q,
    policy_values,
)


def slippery(params, s, a, u):
    """Three places in a row; a step right, or with u in the last fifth a slip back to place 0."""
    goal = params[0]
    if u >= 0.8:
        return 0, -1.0, COLLISION
    return (min(s + 1, 2), 0.0, NOTHING) if s + 1 != goal else (goal, 9.0, TERMINAL)


def row(**settings) -> Domain:
    return Domain("row", 3, 1, slippery, 0.9, **{"outcome_probs": (0.8, 0.2), **settings})


def test_tables_by_hand():
    tables = Task(row(), (2,), np.array([0, 1])).tables()
    assert (tables.n_states, tables.n_actions) == (3, 1)
    assert tables.next_state[:2, 0].tolist() == [[1, 0], [2, 0]]
    assert tables.reward[:2, 0].tolist() == [[0.0, -1.0], [9.0, -1.0]]
    assert tables.event[:2, 0].tolist() == [[NOTHING, COLLISION], [TERMINAL, COLLISION]]
    assert tables.outcome_cum.tolist() == [0.8, 1.0]
    assert tables.starts.tolist() == [0, 1]
    assert [a.dtype for a in tables] == [np.int32, np.float64, np.uint8, np.float64, np.int32]


@pytest.mark.parametrize("answer", [(3, 0.0, NOTHING), (-1, 0.0, NOTHING), (1, np.nan, NOTHING)])
def test_a_step_out_of_the_domain_or_without_a_reward_is_refused(answer):
    domain = Domain("out", 3, 1, lambda params, s, a, u: answer, 0.9)
    with pytest.raises(
        InputError, match="step of domain 'out' must lead to states from 0 to 2 with finite rewards"
    ):
        Task(domain, (), np.array([0])).tables()
    with pytest.raises(InputError, match="starts must name at least one state, numbers from 0 to 2"):
        Task(domain, (), np.array([0.5]))  # pyright: ignore[reportArgumentType]


def test_tabulate_takes_the_place_of_the_enumeration():
    seen = []

    def tabulate(params, midpoints):
        seen.append((params, midpoints.tolist()))
        shape = (3, 1, 2)
        return np.ones(shape, np.int32), np.zeros(shape), np.zeros(shape, np.uint8)

    tables = Task(row(tabulate=tabulate), (2,), np.array([0])).tables()
    assert (tables.next_state == 1).all()
    assert seen == [((2,), [pytest.approx(0.4), pytest.approx(0.9)])]


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"n_states": 0}, "n_states and n_actions must be at least 1, got 0 and 1"),
        ({"n_actions": 0}, "at least 1, got 3 and 0"),
        ({"discount": 1.0}, r"discount must lie in \[0, 1\), got 1.0"),
        ({"discount": float("nan")}, "got nan"),
        ({"outcome_probs": (0.5, 0.6)}, "sum to 1"),
        ({"outcome_probs": (1.5, -0.5)}, "positive"),
        ({"outcome_probs": (float("nan"),)}, "positive and sum to 1"),
        ({"outcome_probs": ()}, "sum to 1"),
    ],
)
def test_domains_that_break_a_rule(settings, message):
    given = {"name": "row", "n_states": 3, "n_actions": 1, "step": slippery, "discount": 0.9} | settings
    with pytest.raises(InputError, match=message):
        Domain(**given)


HAND = Tables.from_matrices(np.eye(3)[[[0, 1], [0, 2], [1, 2]]], [0.0, 0.0, 1.0], terminal=2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"next_state": HAND.next_state + 1}, "next_state and starts must be whole numbers from 0 to 2"),
        ({"starts": np.array([-1])}, "next_state and starts must be"),
        ({"next_state": HAND.next_state.astype(float)}, "next_state and starts must be"),
        ({"reward": HAND.reward[:2]}, "reward and event must be of shape"),
        ({"reward": HAND.reward * np.nan}, "reward and event must be of shape .* rewards finite"),
        ({"outcome_cum": np.array([0.5])}, "outcome_cum must rise to 1"),
    ],
)
def test_tables_made_by_hand_are_checked_where_planning_and_learning_begin(change, message):
    tables = HAND._replace(**change)
    for begin in (
        lambda: optimal_q(tables, 0.9),
        lambda: policy_values(tables, np.zeros(3, np.int32), 0.9),
        lambda: QLearning(episodes=2).learn(tables, 0.9),
    ):
        with pytest.raises(InputError, match=message):
            begin()
