"""Mazes, experts and errands of the claims on advice."""

import numpy as np
import pytest

from lifelore.action.advice.goal_model import GoalModel
from reproduction.chapter3.advice.mazes import expert_walk, goal_models_of, maze_estimate, maze_of, thesis_advisor
from reproduction.engine.registry import claim_of

SMALL = claim_of("C3.15").settings("quick")
CELL = {"loops": 0.1, "maze": 0}


@pytest.fixture(scope="module")
def maze():
    return maze_of(SMALL, CELL, 0)


@pytest.mark.parametrize("alpha0", [0.0, 0.5])
def test_one_theta_is_advised_and_is_the_experts_model(maze, alpha0):
    goal_models = goal_models_of(maze, "walks", alpha0)
    guide = thesis_advisor(goal_models).guide
    counts = GoalModel.pooled(goal_models).prior.counts(np.arange(maze.world.n_states)) + alpha0
    passed = guide.theta[0].any(axis=1)
    theta = counts[passed] / counts[passed].sum(axis=1, keepdims=True)
    np.testing.assert_allclose(guide.theta[0][passed], theta)
    np.testing.assert_allclose(np.exp(guide.log_models[0, passed, 0]), theta, atol=1e-8)
    np.testing.assert_allclose(np.exp(guide.log_models[0, ~passed, 0]), 0.25)


def test_experts_go_shortest_ways(maze):
    random = np.random.default_rng(0)
    for errand in maze.errands.values():
        for start in errand.tables.starts[:5]:
            found = expert_walk(maze.world, errand, int(start), random)
            assert found.states[0] == start
            assert found.states[-1] == errand.goal
            assert len(found.actions) == errand.steps[start]


@pytest.mark.parametrize("experts", ["walks", "trips"])
def test_experts_leave_a_purpose_for_every_goal(maze, experts):
    purposes = goal_models_of(maze, experts, 0.0)
    assert [p.goals[0] for p in purposes] == list(maze.errands)
    for purpose, errand in zip(purposes, maze.errands.values(), strict=True):
        shown = np.any(purpose.theta > 0, axis=1)
        assert not shown[errand.goal]
        # What is advised is best there, and the steps left are those of the shortest way.
        assert not ((purpose.theta > 0) & ~errand.best).any()
        assert (purpose.steps[shown] == errand.steps[shown]).all()


def test_mazes_that_agree_leave_no_doubt():
    assert maze_estimate([2.0, 2.0, 2.0]).ci95 == (2.0, 2.0)
    assert maze_estimate([2.0, 2.0]).ci95 is None
    found = maze_estimate([1.0, 2.0, 4.0])
    assert found.ci95
    assert found.ci95[0] < 7 / 3 < found.ci95[1]
