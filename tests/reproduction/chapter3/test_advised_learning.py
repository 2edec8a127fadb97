"""Q-learning on the errands of a maze: its numbers by hand, and what advice changes and what it does not."""

import json

import numpy as np
import pytest

from reproduction.chapter3.advice.learning import errand_tables, learn_errand
from reproduction.chapter3.advice.mazes import (
    errands_of,
    goal_models_of,
    maze_of,
    policy_of,
    thesis_advisor,
    walk,
)
from reproduction.chapter3.c3_16_advised_learning.run import run_cell, summary
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C3.16").sizes["quick"])

CELL = {"loops": 0.1, "maze": 0}
SCHEDULE = [1.0, 0.99, 0.05]


@pytest.fixture(scope="module")
def maze():
    return maze_of(QUICK, CELL, 0)


@pytest.mark.parametrize(
    ("at", "expected"),
    [
        ([], {"first": 20, "ever": False, "in_ten": False, "final": 0.0}),
        ([0], {"first": 1, "ever": True, "in_ten": True, "final": 0.0}),
        ([9, 19], {"first": 10, "ever": True, "in_ten": True, "final": 250.0}),
        ([10, 16, 17], {"first": 11, "ever": True, "in_ten": False, "final": 500.0}),
    ],
)
def test_a_tasks_numbers_by_hand(at, expected):
    reached = np.zeros(20, bool)
    reached[at] = True
    assert summary({"episodes": 20, "last": 4}, reached) == expected


def test_episodes_start_in_one_cell_or_anywhere(maze):
    errand = errands_of(maze, 1)[0]
    one, again, any_cell = (errand_tables(maze, errand, 0, s).starts for s in ("one", "one", "any"))
    assert one.tolist() == again.tolist()
    assert len(one) == 1
    assert one[0] in any_cell
    assert len(any_cell) > 20


def test_a_learner_starts_where_the_walkers_do(maze):
    errand = errands_of(maze, 2)[1]
    starts = errand_tables(maze, errand, 1, "walker's").starts
    policy = policy_of(maze.world, "optimal", errand)
    advisor = thesis_advisor(QUICK, goal_models_of(QUICK, maze, "walks"))
    assert walk(maze, errand, policy, advisor, 1, 5).states[0] == starts[0]
    assert len(starts) == 1


def test_advice_is_read_in_the_branch_of_epsilon_alone(maze):
    errand = errands_of(maze, 1)[0]
    told = errand.best | ~errand.best.any(axis=1, keepdims=True)
    advice = told / told.sum(axis=1, keepdims=True)

    def curve(epsilon, rows):
        return learn_errand(QUICK, maze, errand.tables, 0, [epsilon, 1.0, epsilon], rows, episodes=30)[1]

    # Always exploring by the best moves is the shortest way; without ε nothing of it is read.
    assert curve(1.0, advice).reached.mean() > 0.8 > curve(1.0, None).reached.mean()
    assert (curve(0.0, advice).steps == curve(0.0, None).steps).all()


def test_fewer_episodes_are_the_beginning_of_more(maze):
    errand = errands_of(maze, 1)[0]
    short, long = (learn_errand(QUICK, maze, errand.tables, 0, SCHEDULE, None, n)[1].steps for n in (10, 40))
    assert (long[:10] == short).all()


def test_a_building_is_learnt_without_advice_and_with_each_alpha0():
    small = {**QUICK, "tasks": 1, "episodes": 20, "last": 5}
    for place, alpha0 in ((0, [None, 0.0, 0.1, 1.0]), (1, [None, 0.0])):
        found = run_cell(small, {"building": place, "maze": 0}, 0)
        assert json.loads(json.dumps(found)) == found
        assert [one["alpha0"] for one in found["beside"]] == alpha0


def test_a_cell_is_plain_data_with_every_way_of_learning():
    small = {**QUICK, "tasks": 1, "episodes": 20, "last": 5}
    found = run_cell(small, CELL, 0)
    assert json.loads(json.dumps(found)) == found
    ways = [(one["starts"], tuple(one["schedule"]), one["experts"]) for one in found["learners"]]
    assert len(set(ways)) == len(ways) == 2 * 2 * (1 + 2)
    assert {experts for _, _, experts in ways} == {None, "walks", "policies"}
