"""Depth-first search by hand and against a plain twin."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.action.search.depth_first import Preferences, depth_first, preferences
from lifelore.core import TERMINAL, InputError, Tables


def tables_of(next_state, goal: int) -> Tables:
    next_state = np.asarray(next_state, np.int32)[..., None]
    event = np.where(next_state == goal, TERMINAL, 0).astype(np.uint8)
    return Tables(next_state, np.zeros(event.shape), event, np.ones(1), np.zeros(1, np.int32))


# Two arms from state 0: action 0 leads through 1, 2, 3 to a dead end, action 1 through 4 to the goal, 5.
FORK = tables_of([[1, 4], [2, 0], [3, 1], [3, 2], [5, 0], [5, 5]], goal=5)


def listed(order, n_tried=None) -> Preferences:
    order = np.asarray(order, np.int32)
    return Preferences(order, np.full(len(order), order.shape[1] if n_tried is None else n_tried, np.int32))


def test_preferences_by_hand():
    preferred = preferences(np.array([[0.1, 0.7, 0.2], [0.5, 0.0, 0.5]]), np.random.default_rng(0), prune=0.15)
    assert preferred.order[0].tolist() == [1, 2, 0]
    assert sorted(preferred.order[1, :2].tolist()) == [0, 2]
    assert preferred.n_tried.tolist() == [2, 2]
    assert preferences(np.full((1, 3), 1 / 3), np.random.default_rng(0), prune=1.0).n_tried.tolist() == [1]


def naive_depth_first(tables, start, preferred):
    seen, count = {start}, SimpleNamespace(expanded=0)

    def beyond(state):
        count.expanded += 1
        for action in preferred.order[state, : preferred.n_tried[state]].tolist():
            after = int(tables.next_state[state, action, 0])
            if tables.event[state, action, 0] & TERMINAL:
                return [action]
            if after not in seen:
                seen.add(after)
                way = beyond(after)
                if way is not None:
                    return [action, *way]
        return None

    return beyond(start), count.expanded


@given(st.integers(0, 10**6), st.integers(1, 14), st.sampled_from([0.0, 0.25]))
def test_it_is_the_recursive_twin(seed, n_states, prune):
    random = np.random.default_rng(seed)
    tables = tables_of(random.integers(0, n_states, (n_states, 3)), goal=0)
    preferred = preferences(random.dirichlet(np.ones(3), n_states), random, prune)
    start = int(random.integers(n_states))
    way, expanded = naive_depth_first(tables, start, preferred)
    found = depth_first(tables, start, preferred)
    assert found.reached == (way is not None)
    assert found.actions.tolist() == (way or [])
    assert found.expanded == expanded <= n_states


def test_each_broken_rule_is_one_clear_line():
    preferred, random = listed([[0, 1]] * 6), np.random.default_rng(0)
    chance = FORK._replace(outcome_cum=np.array([0.5, 1.0]))
    for call, words in (
        (lambda: depth_first(chance, 0, preferred), "needs a deterministic world"),
        (lambda: depth_first(FORK, 6, preferred), "start must lie in"),
        (lambda: depth_first(FORK, 0, listed([[0, 1]])), "preferred must have an order of shape"),
        (lambda: preferences(np.ones(3), random), "probs must be"),
        (lambda: preferences(np.ones((1, 3)), random, prune=2.0), "prune must lie in"),
    ):
        with pytest.raises(InputError, match=words):
            call()
