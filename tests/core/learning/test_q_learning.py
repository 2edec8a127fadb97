"""The Q-learning kernel: by hand, against its naive twin, in chunks, in threads, and where it converges."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core import NOTHING, TERMINAL, InputError, QLearning, Tables, optimal_q, policy_values, stream
from lifelore.core.learning.curve import new_curve
from lifelore.core.learning.q_learning import Rows, Schedule, cumulative, learn, new_learner, uniform_rows

ALL = 10**9


def schedule(episodes, epsilon=0.2, alpha=0.5, max_steps=40, discount=0.9) -> Schedule:
    return Schedule(np.full(episodes, epsilon), np.full(episodes, alpha), max_steps, discount)


def learner(rows, seed=0):
    n_rows, n_actions = int(rows.q_row.max()) + 1, rows.tie_weight.shape[1]
    return new_learner(n_rows, n_actions, stream(seed, "world"), stream(seed, "own"))


def learnt(tables, rows, plan, seed=0, budget=ALL):
    """A learner and its curve after all episodes, run `budget` steps at a time."""
    who, curve = learner(rows, seed), new_curve(len(plan.epsilon))
    while learn(tables, rows, plan, who, curve, budget):
        pass
    return who, curve


def drawn_rows(tables, seed, n_rows=3, n_contexts=4, n_classes=2) -> Rows:
    """Rows of every kind at once: hidden states, contexts by reward class, priors with zeros, tie weights."""
    random = np.random.default_rng(seed)
    explore = random.dirichlet(np.ones(tables.n_actions), n_contexts)
    explore[0] = np.eye(tables.n_actions)[0]
    return Rows(
        np.concatenate([np.arange(n_rows), random.integers(0, n_rows, tables.n_states - n_rows)]).astype(np.int32),
        random.integers(0, n_contexts, (tables.n_states, n_classes)).astype(np.int32),
        random.integers(0, n_classes, tables.next_state.shape).astype(np.uint8),
        cumulative(explore),
        random.uniform(0.1, 2, (n_contexts, tables.n_actions)),
    )


def agree(twin, who, curve) -> bool:
    return (
        np.array_equal(who.q, twin["q"])
        and np.array_equal(who.visits, twin["visits"])
        and who.world_random.tolist() == twin["world"]
        and who.own_random.tolist() == twin["own"]
        and all(np.array_equal(getattr(curve, name), twin[name]) for name in curve._fields)
    )


def corridor(length=3) -> Tables:
    """States 0 … length-1 in a row, one action: on to the next; the last one is the goal, worth 100."""
    here = np.arange(length)
    following = np.minimum(here + 1, length - 1).astype(np.int32)[:, None, None]
    reward = np.where(here == length - 2, 100.0, 0.0)[:, None, None]
    event = np.where(here == length - 2, TERMINAL, NOTHING).astype(np.uint8)[:, None, None]
    return Tables(following, reward, event, np.ones(1), np.zeros(1, np.int32))


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([1, 2, 3]), st.sampled_from([0.0, 0.1, 1.0]))
def test_same_as_the_naive_twin(draw_world, naive_learn, seed, n_outcomes, epsilon):
    tables = draw_world(seed, n_outcomes=n_outcomes)
    rows = drawn_rows(tables, seed)
    random = np.random.default_rng(seed)
    plan = Schedule(np.full(12, epsilon), random.uniform(0, 1, 12), int(random.integers(1, 30)), 0.9)
    start = learner(rows, seed)
    twin = naive_learn(tables, rows, plan, start.world_random, start.own_random)
    assert agree(twin, *learnt(tables, rows, plan, seed))


@pytest.mark.parametrize("budget", [1, 7])
@pytest.mark.parametrize("n_outcomes", [1, 3])
def test_chunks_change_no_bit(draw_world, budget, n_outcomes):
    tables = draw_world(5, n_outcomes=n_outcomes)
    rows = drawn_rows(tables, 5)
    plan = schedule(60)
    whole, whole_curve = learnt(tables, rows, plan)
    parts, parts_curve = learnt(tables, rows, plan, budget=budget)
    for a, b in zip((*whole, *whole_curve), (*parts, *parts_curve), strict=True):
        assert np.array_equal(a, b)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_converges_to_the_optimum_where_every_action_keeps_mass(draw_world, seed):
    tables = draw_world(seed, n_states=10, n_actions=3)
    random = np.random.default_rng(seed)
    # A prior that misleads as hard as it may: 0.94 on one action drawn at random, 0.03 on each other one.
    explore = np.full((10, 3), 0.03)
    explore[np.arange(10), random.integers(0, 3, 10)] = 0.94
    # α = 1 is exact in a deterministic world: once all pairs were tried again, errors shrink by γ = 0.9. A pair
    # is tried at an episode's first step 200,000 / 10 · 0.5 · 0.03 = 300 times on average, deviation 17.
    who, _ = learnt(tables, uniform_rows(tables, explore), schedule(200_000, 0.5, 1.0, 50))
    assert who.visits.min() > 230
    best = optimal_q(tables, 0.9)
    assert who.q == pytest.approx(best, abs=20 * 0.9**200 + 1e-9)
    greedy = policy_values(tables, who.q.argmax(axis=1), 0.9)
    assert greedy == pytest.approx(best.max(axis=1), abs=1e-5)


@pytest.mark.parametrize(
    ("given_rows", "message"),
    [
        ({"explore": [[0.5, 0.6, 0.0]]}, "sum to 1"),
        ({"explore": [[-0.5, 1.0, 0.5]]}, "non-negative"),
        ({"explore": [[np.nan, 1.0, 0.0]]}, "sum to 1"),
        ({"explore": [[0.5, 0.5]]}, "3 columns"),
        ({"ties": [[1.0, 1.0]]}, "agree in shape"),
        ({"ties": [[1.0, 0.0, 1.0]]}, "ties must be positive"),
        ({"context_row": [0, 0]}, "each of 8 states"),
        ({"context_row": [1] * 8}, r"row in \[0, 1\)"),
        ({"context_row": [-1] * 8}, r"row in \[0, 1\)"),
    ],
)
def test_rows_that_break_a_rule(draw_world, given_rows, message):
    with pytest.raises(InputError, match=message):
        uniform_rows(draw_world(0), **given_rows)


def test_probabilities_by_pair_learn_as_the_twin(draw_world, naive_learn):
    tables = draw_world(3, n_outcomes=4)
    own = np.random.default_rng(0).dirichlet(np.ones(4), tables.next_state.shape[:2]).cumsum(axis=2)
    own[..., -1] = 1.0
    tables = tables._replace(outcome_cum=own)
    rows, plan = uniform_rows(tables), schedule(40)
    who, curve = learnt(tables, rows, plan)
    fresh = learner(rows)
    twin = naive_learn(tables, rows, plan, fresh.world_random, fresh.own_random)
    assert agree(twin, who, curve)
    shared = draw_world(3, n_outcomes=4)
    assert agree_arrays(learnt(shared, rows, plan)[0], learnt(shared.by_pair, rows, plan)[0])


def agree_arrays(one, other) -> bool:
    return all(np.array_equal(a, b) for a, b in zip(one, other, strict=True))


@pytest.mark.parametrize(
    ("discount", "rows", "message"),
    [
        (1.5, None, r"discount must lie in \[0, 1\], got 1.5"),
        (float("nan"), None, "got nan"),
        (0.9, np.full((2, 2), 0.5), "rows must come from prior_rows or feature_rows, got ndarray"),
    ],
)
def test_what_q_learning_refuses(discount, rows, message):
    tables = Tables.from_matrices(np.eye(2)[[[1, 1], [1, 1]]], [0.0, 1.0], terminal=1)
    with pytest.raises(InputError, match=message):
        QLearning(5).learn(tables, discount, rows=rows)
