"""The search by sight: by hand, its planner against a naive one, and its counts against a recount."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core import COLLISION, TERMINAL, Tables, stream
from lifelore.core.compiled.random_state import random_state
from lifelore.core.learning.curve import EPISODE, GOALS, TOTAL, new_curve
from lifelore.core.learning.known_value import KnownValue
from lifelore.core.learning.known_world import (
    DEAD_END,
    GOAL,
    LOOKED,
    NOT_LOOKED,
    UNKNOWN,
    WorldModel,
    unknown_world,
)
from lifelore.core.learning.model_learning import ExplorationStrategy, StateInfo, new_model_learner
from lifelore.core.learning.sight_plan import DRIVE, SEARCH, SHORTEN, plan_by_sight
from lifelore.core.learning.sight_search import explore_by_sight, new_sight_search

seeds = st.integers(0, 10**6)


def lists(visible):
    """Begin and states in sight of a square table of bool."""
    return np.concatenate([[0], np.cumsum(visible.sum(axis=1))]), np.nonzero(visible)[1].astype(np.int32)


def graph(edges, n, goal, starts, dead=()):
    """A world whose action k leads along the k-th edge of a state, and is refused where there are fewer."""
    around = [sorted({b for a, b in edges if a == s} | {a for a, b in edges if b == s}) for s in range(n)]
    n_actions = max(map(len, around))
    next_state = np.repeat(np.arange(n, dtype=np.int32)[:, None], n_actions, axis=1)
    for s, others in enumerate(around):
        next_state[s, : len(others)] = others
    refused = next_state == np.arange(n)[:, None]
    reward = np.where(refused, -10.0, np.where(next_state == goal, 100.0, 0.0))
    ends = np.isin(next_state, [goal, *dead]) & ~refused
    event = np.where(refused, COLLISION, np.where(ends, TERMINAL, 0)).astype(np.uint8)
    return Tables(
        next_state[..., None], reward[..., None], event[..., None], np.ones(1), np.array(starts, np.int32)
    )


def lived(tables, visible, model, episodes=1, budget=10**6, strategy=None, seed=0, max_steps=1000):
    """Learner, search and curve after at most `budget` steps."""
    n, n_actions = tables.n_states, tables.n_actions
    learner = new_model_learner(n, n_actions, stream(seed, "world"), stream(seed, "own"))
    search, curve = new_sight_search(*lists(visible), tables, model), new_curve(episodes)
    info = StateInfo(np.arange(n), np.zeros(n, np.int32), np.zeros((1, n_actions)))
    explore_by_sight(
        tables, model, info, strategy or ExplorationStrategy(), learner, search, curve, max_steps, 0.9, budget
    )
    return learner, search, curve


def within(n, reach):
    """A corridor in which states at most `reach` apart are in sight."""
    return abs(np.subtract.outer(np.arange(n), np.arange(n))) <= reach


# ---- by hand -----------------------------------------------------------------------------------------


def test_the_goal_is_not_known_before_it_is_in_sight():
    tables = graph(list(pairwise(range(9))), 9, goal=8, starts=[0])
    learner, search, _ = lived(tables, within(9, 2), unknown_world(9, 2), budget=5)
    assert learner.cursor[TOTAL] == 5
    assert learner.cursor[GOALS] == 0
    assert search.found.tolist() == [-1, -1]
    # In state 5, states up to 7 are seen; state 8 is known by a move and not yet seen.
    _, search, _ = lived(tables, within(9, 2), unknown_world(9, 2), budget=6)
    assert search.new.tolist() == [0] * 8 + [1]
    _, search, _ = lived(tables, within(9, 2), unknown_world(9, 2), budget=7)
    assert search.found.tolist() == [6, 0]


# ---- against a naive planner -------------------------------------------------------------------------


def naive_best(target, remembered, place, gain, purpose) -> tuple[set[int], dict[int, int]]:
    """The places to which a plan may lead, and the steps to every place, from state 0."""
    steps, level = {0: 0}, [0]
    while level:
        ahead = []
        for s in level:
            for t in target[s].tolist():
                if t != UNKNOWN and t not in steps:
                    steps[t] = steps[s] + 1
                    if place[t] not in (GOAL, DEAD_END):
                        ahead.append(t)
        level = ahead
    others = [t for t in steps if t != 0]
    goals = [t for t in others if place[t] == GOAL]
    nearest = list(goals) if purpose != SEARCH else []
    if purpose == SHORTEN:
        nearest += [t for t in others if place[t] == NOT_LOOKED and remembered[t] == UNKNOWN]
    if nearest:
        least = min(steps[t] for t in nearest)
        at_least = {t for t in nearest if steps[t] == least}
        return at_least & set(goals) or at_least, steps
    scores = {t: gain[t] / steps[t] for t in others if place[t] not in (GOAL, DEAD_END) and gain[t] > 0}
    if scores:
        return {t for t in scores if scores[t] == max(scores.values())}, steps
    return {t for t in goals if steps[t] == min(steps[t] for t in goals)}, steps


@settings(max_examples=40, deadline=None)
@given(seeds, st.sampled_from([SEARCH, DRIVE, SHORTEN]))
def test_a_plan_leads_to_a_best_place_on_a_shortest_path(seed, purpose):
    random = np.random.default_rng(seed)
    n, n_actions = 14, 3
    target = random.integers(0, n, (n, n_actions)).astype(np.int32)
    target[random.random(target.shape) < 0.3] = UNKNOWN
    place = random.choice([NOT_LOOKED, LOOKED, LOOKED, DEAD_END, GOAL], n, p=[0.3, 0.3, 0.2, 0.1, 0.1]).astype(
        np.int8
    )
    place[0] = LOOKED
    remembered = random.choice([UNKNOWN, 5], n)
    gain = random.choice([0, 0, 1, 2, 6], n).astype(np.int32)
    desk = new_model_learner(n, n_actions, stream(0, "world"), stream(0, "own"))
    learner = desk._replace(place=place, own_random=random_state(stream(seed, "own")))
    length = plan_by_sight(0, WorldModel(target, remembered), learner, gain, purpose)
    assert (desk.parent == UNKNOWN).all()
    best, steps = naive_best(target, remembered, place, gain, purpose)
    assert bool(length) == bool(best)
    s = 0
    for a in desk.plan[:length][::-1]:
        s = int(target[s, a])
    assert not length or (s in best and length == steps[s])


# ---- properties --------------------------------------------------------------------------------------


def random_rooms(seed, n=24):
    """A connected world, who sees whom, and a memory of another version of it."""
    random = np.random.default_rng(seed)
    edges = [(s, int(random.integers(max(0, s - 4), s))) for s in range(1, n)]
    edges += [tuple(pair) for pair in random.integers(0, n, (5, 2)).tolist() if pair[0] != pair[1]]
    tables = graph(edges, n, goal=int(random.integers(1, n)), starts=[0])
    visible = random.random((n, n)) < random.choice([0.0, 0.1, 0.3])
    visible[tuple(np.transpose(edges))] = True
    visible = visible | visible.T | np.eye(n, dtype=bool)
    model = unknown_world(n, tables.n_actions)
    known = random.random(n) < random.choice([0.0, 0.5, 1.0])
    model.percept[known] = 99
    model.target[known] = tables.next_state[known, :, 0]
    wrong = known[:, None] & (random.random(model.target.shape) < random.choice([0.0, 0.3]))
    model.target[wrong] = random.integers(0, n, int(wrong.sum()))
    return tables, visible, model


@settings(max_examples=40, deadline=None)
@given(seeds, st.integers(0, 60))
def test_counts_are_those_of_a_recount_and_the_seen_map_is_true(seed, budget):
    tables, visible, model = random_rooms(seed)
    before = (model.percept != UNKNOWN).copy()
    named = np.isin(np.arange(tables.n_states), model.target)
    learner, search, _ = lived(tables, visible, model, episodes=3, budget=budget, seed=seed)
    looked = learner.place != NOT_LOOKED
    assert np.array_equal(model.target[looked], tables.next_state[looked, :, 0])
    assert np.array_equal(looked, visible[search.stood == 1].any(axis=0))
    named |= np.isin(np.arange(tables.n_states), model.target[looked])
    assert np.array_equal(search.new == 1, (before | named) & ~looked)
    assert np.array_equal(search.gain, visible @ search.new)


@settings(max_examples=40, deadline=None)
@given(seeds, st.booleans())
def test_every_goal_is_found_whatever_was_remembered(seed, exhaustive):
    tables, visible, model = random_rooms(seed)
    strategy = ExplorationStrategy(exhaustive=exhaustive)
    # Each plan ends where something new is seen, at most 24 times, after at most 24 steps.
    learner, search, curve = lived(
        tables, visible, model, episodes=6, max_steps=24 * 24, strategy=strategy, seed=seed
    )
    assert curve.reached.all()
    assert not curve.collisions.any()
    assert search.found[0] >= 0
    value = KnownValue(tables, model, learner, 0.9)
    assert value.update() == pytest.approx(value.exact())


def test_a_search_in_pieces_is_the_search_in_one():
    tables, visible, model = random_rooms(5)
    other = WorldModel(model.target.copy(), model.percept.copy())
    learner, search, curve = lived(tables, visible, model, episodes=4)
    n, n_actions = tables.n_states, tables.n_actions
    again = new_model_learner(n, n_actions, stream(0, "world"), stream(0, "own"))
    pieces, curve_again = new_sight_search(*lists(visible), tables, other), new_curve(4)
    info = StateInfo(np.arange(n), np.zeros(n, np.int32), np.zeros((1, n_actions)))
    while explore_by_sight(tables, other, info, ExplorationStrategy(), again, pieces, curve_again, 1000, 0.9, 3):
        pass
    assert again.cursor[EPISODE] == learner.cursor[EPISODE] == 4
    for one, two in zip((*search, *curve, *model), (*pieces, *curve_again, *other), strict=True):
        assert np.array_equal(one, two)
