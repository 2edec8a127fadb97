"""The model-based learner: step by step beside a naive book-keeper, and in worlds that changed."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.core.learning.curve import new_curve
from lifelore.core.learning.known_world import (
    DEAD_END,
    GOAL,
    LOOKED,
    NOT_LOOKED,
    UNKNOWN,
    WorldModel,
    known_policy,
    unknown_world,
)
from lifelore.core.learning.model_learning import (
    ExplorationStrategy,
    StateInfo,
    check_deterministic,
    explore,
    new_model_learner,
)
from lifelore.core.mdp import COLLISION, TERMINAL, Tables
from lifelore.core.planning.planning import mean_start_value, optimal_q, policy_values
from lifelore.core.streams import stream

ALL = 10**9
PLANNED = ExplorationStrategy()
LEFT, RIGHT = 0, 1


def corridor(walls=(), n=6, goal=5, start=0) -> Tables:
    """Places in a row, moves left and right; a wall i stands between i and i + 1."""
    next_state = np.empty((n, 2, 1), np.int32)
    reward, event = np.zeros((n, 2, 1)), np.zeros((n, 2, 1), np.uint8)
    for s in range(n):
        for a, step in ((LEFT, -1), (RIGHT, 1)):
            refused = not 0 <= s + step < n or min(s, s + step) in walls
            t = s if refused else s + step
            next_state[s, a] = t
            if refused:
                reward[s, a], event[s, a] = -10, COLLISION
            elif t == goal:
                reward[s, a], event[s, a] = 100, TERMINAL
    return Tables(next_state, reward, event, np.ones(1), np.array([start], np.int32))


def perceived(tables, percept=None, try_cost=0.0) -> StateInfo:
    n = tables.n_states
    percept = np.zeros(n, np.int64) if percept is None else np.asarray(percept, np.int64)
    return StateInfo(percept, np.zeros(n, np.int32), np.full((1, tables.n_actions), float(try_cost)))


def remembered(tables, percept=None) -> WorldModel:
    """Everything known of how the world was."""
    seen = np.zeros(tables.n_states, np.int64) if percept is None else np.asarray(percept, np.int64)
    return WorldModel(tables.next_state[:, :, 0].copy(), seen)


def new(tables, seed=0):
    return new_model_learner(tables.n_states, tables.n_actions, stream(seed, "world"), stream(seed, "own"))


def lived(tables, model, seen=None, strategy=PLANNED, episodes=3, max_steps=100, budget=ALL, seed=0):
    """The explorer and its curve after all episodes; `model` learns in place."""
    explorer, curve = new(tables, seed), new_curve(episodes)
    seen = perceived(tables) if seen is None else seen
    while explore(tables, model, seen, strategy, explorer, curve, max_steps, 0.9, budget):
        pass
    return explorer, curve


# ---- by hand -----------------------------------------------------------------------------------------


def test_the_goal_is_seen_in_an_unknown_world_and_then_sought():
    tables = corridor(start=2)
    model = unknown_world(6, 2)
    explorer, curve = lived(tables, model, episodes=30, seed=1)
    assert curve.reached[-5:].all()
    assert (curve.steps[-5:] == 3).all()
    greedy = policy_values(tables, known_policy(model, explorer.place), 0.9)
    assert mean_start_value(tables, greedy) == pytest.approx(optimal_q(tables, 0.9)[2].max())
    # What was learnt is true, and the percepts of visited places are remembered.
    known = model.target != UNKNOWN
    assert (model.target[known] == tables.next_state[:, :, 0][known]).all()
    assert ((model.percept == 0) == (explorer.place == LOOKED)).all()


# ---- a naive book-keeper beside every step ------------------------------------------------------------


class Bookkeeper:
    """What is known, tried and looked at, kept in dictionaries; checks each step of the kernel."""

    def __init__(self, tables, model, seen, strategy):
        self.tables, self.seen, self.strategy = tables, seen, strategy
        self.target = {at: int(t) for at, t in np.ndenumerate(model.target)}
        self.percept = dict(enumerate(model.percept.tolist()))
        self.place = dict.fromkeys(range(tables.n_states), NOT_LOOKED)
        self.tried = dict.fromkeys(self.target, 0)

    def arrive(self, s):
        if self.place[s] != NOT_LOOKED:
            return
        self.place[s] = LOOKED
        if self.percept[s] != self.seen.percept[s]:
            for a in range(self.tables.n_actions):
                if not self.tried[s, a]:
                    self.target[s, a] = UNKNOWN
            self.percept[s] = int(self.seen.percept[s])
        if self.strategy.senses:
            for a in range(self.tables.n_actions):
                self.target[s, a] = int(self.tables.next_state[s, a, 0])

    def doubt(self):
        for (s, a), t in self.target.items():
            if t == s and not self.tried[s, a]:
                self.target[s, a] = UNKNOWN

    def worth(self, start):
        """Steps to everything worth doing from `start`, breadth first; only its least cost matters."""
        goal_known = GOAL in self.place.values()
        steps, waiting, costs = {start: 0}, [start], {}
        for s in waiting:
            for a in range(self.tables.n_actions):
                t, depth = self.target[s, a], steps[s] + 1
                if t == UNKNOWN:
                    costs[s, a] = depth + self.seen.try_cost[self.seen.cost_row[s], a]
                elif self.place[t] == GOAL:
                    costs[s, a] = np.inf if self.strategy.exhaustive else depth
                elif self.place[t] == NOT_LOOKED and not goal_known:
                    beside = {(t, b) for b in range(self.tables.n_actions)}
                    near = [self.target[at] for at in beside if self.target[at] not in (UNKNOWN, t)]
                    costs[s, a] = depth + 0.2 * sum(self.place[x] == NOT_LOOKED for x in near)
                elif self.place[t] != DEAD_END and t not in steps:
                    steps[t] = depth
                    waiting.append(t)
        return costs

    def step(self, s, a):
        self.tried[s, a] += 1
        t = self.target[s, a] = int(self.tables.next_state[s, a, 0])
        if self.tables.event[s, a, 0] & TERMINAL:
            self.place[t] = GOAL if self.tables.reward[s, a, 0] > 0 else DEAD_END
        return t


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(
    st.integers(0, 10**6),
    st.booleans(),
    st.sampled_from(
        [
            ExplorationStrategy(),
            ExplorationStrategy(exhaustive=True),
            ExplorationStrategy(senses=True),
            ExplorationStrategy(planned=False),
        ]
    ),
)
def test_every_step_beside_a_naive_bookkeeper(draw_world, seed, with_memory, strategy):
    tables = draw_world(seed, n_states=12)
    random = np.random.default_rng(seed)
    model = unknown_world(12, 3)
    if with_memory:  # true in most places only
        model = remembered(tables, random.integers(0, 2, 12))
        model.target[random.random((12, 3)) < 0.2] = random.integers(-1, 12)
    seen = StateInfo(
        random.integers(0, 2, 12), random.integers(0, 2, 12).astype(np.int32), random.choice([0, 3.0], (2, 3))
    )
    book = Bookkeeper(tables, model, seen, strategy)
    explorer, curve = new(tables, seed), new_curve(40)
    plan: list[int] = []
    for _ in range(400):
        tried, s, fresh = explorer.tried.copy(), int(explorer.cursor[2]), explorer.cursor[1] == 0
        if not explore(tables, model, seen, strategy, explorer, curve, 40, 0.9, 1):
            break
        ((acted_in, action),) = np.argwhere(explorer.tried != tried).tolist()
        if fresh:
            s, plan = acted_in, []
        assert acted_in == s
        newly = book.place[s] == NOT_LOOKED
        book.arrive(s)
        if strategy.planned:
            if not plan or (newly and strategy.senses):
                plan = _checked_plan(book, s, explorer, action)
            assert plan.pop(0) == action
        else:
            assert book.tried[s, action] == min(book.tried[s, a] for a in range(3))
        expected = book.target[s, action]
        following = book.step(s, action)
        if following != expected:
            plan = []
        assert model.target.tolist() == [[book.target[s, a] for a in range(3)] for s in range(12)]
        assert explorer.place.tolist() == list(book.place.values())
        assert model.percept.tolist() == list(book.percept.values())
        assert explorer.cursor[2] == following
    assert explorer.tried.sum() == explorer.cursor[4]


def _checked_plan(book, s, explorer, action) -> list[int]:
    """The whole plan whose first action was just done, from the kernel's desk, once found to be a cheapest."""
    costs = book.worth(s)
    if not costs:  # nothing is left: doubt, and move at random
        book.doubt()
        return [action]
    walked = [action, *explorer.plan[: explorer.cursor[3]][::-1].tolist()]
    surprised = book.target[s, action] != book.tables.next_state[s, action, 0]
    if surprised or explorer.cursor[1] == 0:  # a surprise and an episode's end clear the plan: no more to see
        return walked
    at = s
    for a in walked[:-1]:
        at = book.target[at, a]
    assert costs[at, walked[-1]] <= min(costs.values()) + 1e-9
    return walked


@pytest.mark.parametrize("budget", [1, 7])
@pytest.mark.parametrize(
    "strategy", [ExplorationStrategy(), ExplorationStrategy(planned=False), ExplorationStrategy(senses=True)]
)
def test_chunks_change_no_bit(draw_world, budget, strategy):
    tables = draw_world(11, n_states=30)
    models = unknown_world(30, 3), unknown_world(30, 3)
    whole = lived(tables, models[0], strategy=strategy, episodes=40)
    parts = lived(tables, models[1], strategy=strategy, episodes=40, budget=budget)
    for a, b in zip((*whole[0], *whole[1], *models[0]), (*parts[0], *parts[1], *models[1]), strict=True):
        assert np.array_equal(a, b)


def test_worlds_it_cannot_plan_in(draw_world):
    check_deterministic(draw_world(0))
    with pytest.raises(InputError, match="one outcome a move to be planned with, got 3"):
        check_deterministic(draw_world(0, n_outcomes=3))
    for n_actions in (0, 128):
        with pytest.raises(InputError, match=rf"n_actions must lie in \[1, 127\], got {n_actions}"):
            new_model_learner(5, n_actions, stream(0), stream(1))
