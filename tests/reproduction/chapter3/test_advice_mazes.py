"""Mazes, experts and errands of the claims on advice."""

import numpy as np
import pytest

from lifelore.action.advice.goal_model import GoalModel
from lifelore.core.planning.planning import best_actions, optimal_q
from reproduction.chapter3.advice.mazes import (
    AGENTS,
    EXPERTS,
    errands_of,
    expert_walk,
    goal_models_of,
    grid_of,
    grid_share,
    maze_cells,
    maze_estimate,
    maze_of,
    policy_of,
    thesis_advisor,
    walk,
)
from reproduction.engine.estimates import exact_value, is_above
from reproduction.engine.registry import claim_of

SMALL = claim_of("C3.15").settings("quick")
CELL = {"loops": 0.1, "maze": 0}


@pytest.fixture(scope="module")
def maze():
    return maze_of(SMALL, CELL, 0)


def test_closed_goals_bar_the_way_and_their_errands_start_where_a_way_is_left():
    found = maze_of({**SMALL, "size": 21}, {"loops": 0.4, "maze": 1}, 0, "wall")
    passing = maze_of({**SMALL, "size": 21}, {"loops": 0.4, "maze": 1}, 0)
    assert set(found.errands) <= set(passing.errands)
    for goal, errand in found.errands.items():
        others = [other for other in passing.errands if other != goal]
        assert not np.isin(errand.moves, others).any()
        assert (errand.steps[errand.tables.starts] > 0).all()
        assert errand.best[errand.tables.starts].any(axis=1).all()
        reached = errand.steps[errand.moves[errand.best]]
        assert (reached >= 0).all()
        assert (errand.steps[errand.tables.starts] >= passing.errands[goal].steps[errand.tables.starts]).all()


def test_alpha0_in_the_advice_advises_other_actions_where_experts_passed(maze):
    goal_models = goal_models_of(SMALL, maze, "walks")
    plain, spread = (thesis_advisor(SMALL, goal_models, alpha0=a).guide.theta[0] for a in (0.0, 0.5))
    passed = plain.any(axis=1)
    counts = GoalModel.pooled(goal_models).prior.counts(np.arange(len(plain)))[passed]
    np.testing.assert_allclose(spread[passed], (counts + 0.5) / (counts.sum(axis=1, keepdims=True) + 2))
    assert not spread[~passed].any()


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
    purposes = goal_models_of(SMALL, maze, experts)
    assert [p.goals[0] for p in purposes] == list(maze.errands)
    for purpose, errand in zip(purposes, maze.errands.values(), strict=True):
        told = np.any(purpose.theta > 0, axis=1)
        assert not told[errand.goal]
        # What is advised is best there, and the steps left are those of the shortest way.
        assert not ((purpose.theta > 0) & ~errand.best).any()
        assert (purpose.steps[told] == errand.steps[told]).all()
    shown = np.mean([np.isfinite(p.steps).mean() for p in purposes])
    assert (shown > 0.95) == (experts == "policies")


def test_trips_start_at_other_goals(maze):
    for purpose in goal_models_of(SMALL, maze, "trips"):
        farthest = np.argmax(np.where(np.isfinite(purpose.steps), purpose.steps, -1))
        assert farthest in set(maze.errands) - set(purpose.goals)


def test_agents_have_policies_and_the_optimal_one_takes_no_step_too_many(maze):
    errand = errands_of(maze, 1)[0]
    advisor = thesis_advisor(SMALL, goal_models_of(SMALL, maze, "walks"))
    for agent in AGENTS:
        np.testing.assert_allclose(policy_of(maze.world, agent, errand).sum(axis=-1), 1)
    found = walk(maze, errand, policy_of(maze.world, "optimal", errand), advisor, 0, 500, heeds=False)
    assert found.reached
    assert len(found.states) == errand.steps[found.states[0]]


def test_told_or_not_a_walk_starts_alike(maze):
    errand = errands_of(maze, 1)[0]
    advisor = thesis_advisor(SMALL, goal_models_of(SMALL, maze, "walks"))
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


def test_a_gain_that_is_only_rounding_is_not_certain():
    assert is_above(maze_estimate([1.0, 2.0, 3.0, 2.0]), 0.0)
    assert not is_above(maze_estimate([-5.0, 2.0, 3.0, 2.0]), 0.0)
    assert not is_above(maze_estimate([0.0, 0.0, 0.0]), 0.0)
    assert not is_above(maze_estimate([1.0, 1.0]), 0.0)
    assert not is_above(maze_estimate([2e-17, 1e-17, 3e-17]), 0.0)


def test_shares_of_the_grid():
    assert grid_of({"loops": [0.0, 0.1], "experts": ["walks", "trips"]})[1:3] == [(0.0, "trips"), (0.1, "walks")]
    assert grid_share([True, False, False, False]) == exact_value(0.25, 4)
