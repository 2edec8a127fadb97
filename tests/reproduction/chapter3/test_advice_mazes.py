"""Mazes, experts and errands of the claims on advice."""

import numpy as np
import pytest

from lifelore.action.advice.goal_model import GoalModel
from lifelore.core.planning.planning import best_actions, optimal_q
from reproduction.chapter3.advice.mazes import (
    AGENTS,
    EXPERTS,
    choices_of,
    errands_of,
    expert_walk,
    goal_models_of,
    maze_cells,
    maze_estimate,
    maze_of,
    policy_of,
    readings_of,
    thesis_advisor,
    walk,
)
from reproduction.engine.registry import claim_of
from reproduction.engine.statement import YES, Statement

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


def test_cells_are_mazes_by_loop_density():
    assert maze_cells({"loops": [0.0, 0.2], "mazes": 2}) == [
        {"loops": 0.0, "maze": 0},
        {"loops": 0.0, "maze": 1},
        {"loops": 0.2, "maze": 0},
        {"loops": 0.2, "maze": 1},
    ]


def test_mazes_and_errands_depend_on_seed_and_number_and_come_again(maze):
    again = maze_of(SMALL, CELL, 0)
    assert (again.world.neighbour == maze.world.neighbour).all()
    assert [e.goal for e in errands_of(again, 6)] == [e.goal for e in errands_of(maze, 6)]
    other = maze_of(SMALL, {"loops": 0.1, "maze": 1}, 0).world.neighbour
    assert other.shape != maze.world.neighbour.shape or (other != maze.world.neighbour).any()
    # A longer list of errands begins as the shorter.
    assert [e.goal for e in errands_of(maze, 9)][:6] == [e.goal for e in errands_of(maze, 6)]


def test_best_moves_are_those_of_the_exact_policy(maze):
    for errand in maze.errands.values():
        others = np.arange(maze.world.n_states) != errand.goal
        best = best_actions(optimal_q(errand.tables, maze.world.discount))
        assert (best[others] == errand.best[others]).all()
        assert not errand.best[errand.goal].any()
        assert errand.steps[errand.goal] == 0


def test_experts_go_shortest_ways(maze):
    random = np.random.default_rng(0)
    for errand in maze.errands.values():
        for start in errand.tables.starts[:5]:
            found = expert_walk(maze.world, errand, int(start), random)
            assert found.states[0] == start
            assert found.states[-1] == errand.goal
            assert len(found.actions) == errand.steps[start]


@pytest.mark.parametrize("experts", EXPERTS)
def test_experts_leave_a_purpose_for_every_goal(maze, experts):
    purposes = goal_models_of(maze, experts, 0.0)
    assert [p.goals[0] for p in purposes] == list(maze.errands)
    for purpose, errand in zip(purposes, maze.errands.values(), strict=True):
        shown = np.any(purpose.theta > 0, axis=1)
        assert not shown[errand.goal]
        # What is advised is best there, and the steps left are those of the shortest way.
        assert not ((purpose.theta > 0) & ~errand.best).any()
        assert (purpose.steps[shown] == errand.steps[shown]).all()


def test_trips_start_at_other_goals(maze):
    for purpose in goal_models_of(maze, "trips", 0.1):
        farthest = np.argmax(np.where(np.isfinite(purpose.steps), purpose.steps, -1))
        assert farthest in set(maze.errands) - set(purpose.goals)


def test_agents_have_policies_and_the_optimal_one_takes_no_step_too_many(maze):
    errand = errands_of(maze, 1)[0]
    advisor = thesis_advisor(goal_models_of(maze, "walks", 0.1))
    for agent in AGENTS:
        np.testing.assert_allclose(policy_of(maze.world, agent, errand).sum(axis=-1), 1)
    found = walk(maze, errand, policy_of(maze.world, "optimal", errand), advisor, 0, 500, heeds=False)
    assert found.reached
    assert len(found.states) == errand.steps[found.states[0]]


def test_told_or_not_a_walk_starts_alike(maze):
    errand = errands_of(maze, 1)[0]
    advisor = thesis_advisor(goal_models_of(maze, "walks", 0.1))
    alone, told = (
        walk(maze, errand, policy_of(maze.world, "random", errand), advisor, 0, 200, heeds)
        for heeds in (False, True)
    )
    first = int(np.argmax(told.advised))
    assert not alone.advised.any()
    assert (alone.states[: first + 1] == told.states[: first + 1]).all()


def test_mazes_that_agree_leave_no_doubt():
    assert maze_estimate([2.0, 2.0, 2.0]).ci95 == (2.0, 2.0)
    assert maze_estimate([2.0, 2.0]).ci95 is None
    found = maze_estimate([1.0, 2.0, 4.0])
    assert found.ci95
    assert found.ci95[0] < 7 / 3 < found.ci95[1]


def is_positive(estimate) -> bool:
    return Statement.parsed("x is positive", "x > 0").mark({"x": estimate.to_dict()}) == YES


def test_a_gain_that_is_only_rounding_is_not_certain():
    assert is_positive(maze_estimate([1.0, 2.0, 3.0, 2.0]))
    assert not is_positive(maze_estimate([-5.0, 2.0, 3.0, 2.0]))
    assert not is_positive(maze_estimate([0.0, 0.0, 0.0]))
    assert not is_positive(maze_estimate([2e-17, 1e-17, 3e-17]))


def test_readings_cross_loops_experts_and_alpha0():
    settings = {"loops": [0.1, 0.0], "experts": ["walks", "trips"], "alpha0": [0.1]}
    assert choices_of(settings) == [{"experts": "walks", "alpha0": 0.1}, {"experts": "trips", "alpha0": 0.1}]
    assert readings_of(settings)[3] == ({"loops": 0.0, "experts": "trips", "alpha0": 0.1}, 0.0, 1)
