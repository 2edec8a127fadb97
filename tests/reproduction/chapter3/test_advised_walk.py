"""Walks under an advisor's eyes: by hand, as the slow twin."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.action.advice.advisor import AdviceSettings, Advisor
from lifelore.action.advice.behaviour_models import Tabulated, Uniform
from lifelore.action.advice.goal_model import GoalModel, Trajectory
from lifelore.core.compiled.random_state import next_uniform, random_state
from lifelore.core.mdp import COLLISION, TERMINAL, Tables
from reproduction.chapter3.advice.advised_walk import advised_walk

from .naive_advisor import NaiveAdvisor

EAST, WEST = 0, 1


def corridor(length: int) -> Tables:
    """Places in a row; the last one, entered, is the goal and worth 1000."""
    here = np.arange(length)
    next_state = np.stack([np.minimum(here + 1, length - 1), np.maximum(here - 1, 0)], axis=1)[..., None]
    reward = np.where(next_state == length - 1, 1000.0, 0.0)
    event = np.where(next_state == length - 1, TERMINAL, 0).astype(np.uint8)
    event[0, WEST] = COLLISION
    return Tables(next_state.astype(np.int32), reward, event, np.ones(1), np.zeros(1, np.int32))


def going_east(length: int) -> GoalModel:
    return GoalModel.from_trajectories(
        [Trajectory(np.arange(length), np.zeros(length - 1, int))], length, 2, goals=[length - 1]
    )


def test_told_the_way_it_goes_straight_there():
    ten = corridor(10)
    west = np.tile([0.0, 1.0], (10, 1))
    alone = advised_walk(ten, west, Advisor([going_east(10)]), np.random.default_rng(0), 50, follows_advice=False)
    assert (alone.reached, len(alone.states), alone.reward) == (False, 50, 0.0)
    assert not alone.advised.any()
    always = Advisor([going_east(10)], settings=AdviceSettings(kappa=0))
    told = advised_walk(ten, west, always, np.random.default_rng(0), 50)
    assert (told.reached, told.reward) == (True, 1000.0)
    assert told.states.tolist() == list(range(9))
    assert (told.actions == EAST).all()
    assert told.advised.all()


def test_as_it_goes_normally_advice_falls_silent():
    # Going east by itself it soon seems an expert: KL falls to -log P(east | M₁) = log(1.2 / 1.1).
    east = np.tile([1.0, 0.0], (100, 1))
    advisor = Advisor([going_east(100)], settings=AdviceSettings(kappa=0.2))
    walk = advised_walk(corridor(100), east, advisor, np.random.default_rng(0), 5000)
    assert walk.advised[0]
    assert not walk.advised[5:].any()
    assert walk.p_normal[0] == pytest.approx(0.5)
    assert (np.diff(walk.p_normal[:20]) > 0).all()
    assert walk.gain[-1] == pytest.approx(np.log(1.2 / 1.1))


@pytest.mark.slow
@settings(max_examples=40)
@given(st.integers(0, 10**6), st.integers(1, 3), st.booleans(), st.sampled_from([1.0, 0.4]))
def test_as_the_naive_twin(seed, n_goals, follows_advice, share):
    random = np.random.default_rng(seed)
    tables = Tables(
        random.integers(0, 6, (6, 3, 1)).astype(np.int32),
        random.normal(size=(6, 3, 1)),
        (random.random((6, 3, 1)) < 0.03).astype(np.uint8),
        np.ones(1),
        np.arange(6, dtype=np.int32),
    )
    purposes = [
        GoalModel.from_trajectories([Trajectory(random.integers(0, 6, 9), random.integers(0, 3, 8))], 6, 3, [g])
        for g in range(n_goals)
    ]
    policy = random.dirichlet(np.ones(3), (6, 4))
    options = AdviceSettings(kappa=0.1, window=8, slip=0.05, share=share, burst=3, own_steps_only=share < 1)
    advisor = Advisor(purposes, [Uniform(3), Tabulated(policy)], options)
    walk = advised_walk(tables, policy, advisor, np.random.default_rng(seed), 40, follows_advice=follows_advice)

    uniform = random_state(np.random.default_rng(seed))
    state, previous, total = int(next_uniform(uniform) * 6), -1, 0.0
    twin = NaiveAdvisor(advisor.guide, options)
    for t in range(len(walk.states)):
        told, gain, posterior = twin.consider(state)
        told = told and follows_advice
        row = advisor.guide.theta[twin.target][state] if told else policy[state, previous + 1]
        action = int((next_uniform(uniform) >= np.cumsum(row)[:-1]).sum())
        assert (walk.states[t], walk.actions[t], walk.advised[t]) == (state, action, told)
        assert walk.gain[t] == pytest.approx(gain, abs=1e-9)
        assert walk.p_normal[t] == pytest.approx(sum(posterior[:n_goals]), abs=1e-9)
        twin.observe(state, action, told)
        total += tables.reward[state, action, 0]
        ended = bool(tables.event[state, action, 0] & TERMINAL)
        state, previous = int(tables.next_state[state, action, 0]), action
        assert ended == (t == len(walk.states) - 1 and walk.reached)
    assert walk.reward == pytest.approx(total)
    assert walk.reached or len(walk.states) == 40
