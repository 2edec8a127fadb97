"""Worlds of C3.13 by hand: the constructed worst case, its frequency, and what counts as below the bound."""

import numpy as np
import pytest

from lifelore.action.search.domain_reduction import domain_futile_states
from lifelore.core.learning.q_learning import uniform_rows
from reproduction.chapter3.c3_13_futile_goals.run import (
    best_in,
    constructed,
    constructed_cases,
    found_case,
    frequency,
    goal_tables,
)
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C3.13").sizes["quick"])

SETTINGS = {**QUICK, "draws": 4000, "actions": [2, 4], "alpha0": [0.5], "tasks": [0, 1, 3], "alike": [2]}
SETTINGS["default"] = {"actions": 4, "alpha0": 0.5}


def test_the_constructed_world_by_hand():
    # Two junctions 0 and 1, room 2, goals 3 and 4, new goal 5; action 1 of three leads to it.
    world = constructed(3, 2, 2, 1)
    assert world.follow.tolist() == [[2, 5, 2], [2, 1, 2], [3, 3, 3], [4, 4, 4], [0, 0, 0], [0, 0, 0]]
    assert (world.goals, world.new_goal) == ([3, 4], 5)
    tasks = [goal_tables(world.follow, goal, [0, 1]) for goal in world.goals]
    policies = [best_in(task, goal) for task, goal in zip(tasks, world.goals, strict=True)]
    for best in policies:
        assert best[:2].tolist() == [[True, False, True]] * 2
    assert np.flatnonzero(domain_futile_states(tasks, policies)).tolist() == [5]


def test_constructed_cases_by_hand():
    cases = {(c["actions"], c["alike"], c["tasks"]): c for c in constructed_cases(SETTINGS, 0, 0)}
    assert len(cases) == 2 * 2 * 3
    # 0.5 / (3 (1 + 0.5) + 0.5) and, of two states alike after three tasks, 0.5 / (1 (6 + 0.5) + 0.5).
    assert cases[4, 1, 1]["formula"] == cases[4, 1, 1]["prior"] == pytest.approx(0.1)
    assert cases[2, 2, 3]["formula"] == cases[2, 2, 3]["prior"] == pytest.approx(1 / 14)
    assert cases[4, 2, 0]["prior"] == 0.25
    assert {key for key, case in cases.items() if "taken_uniform_ties" in case} == {(4, 1, n) for n in (0, 1, 3)}
    for case in cases.values():
        expected = 4000 * case["formula"]
        assert abs(case["taken"] - expected) < 5 * np.sqrt(expected)
    # A tenth explores, the rest breaks a tie of four.
    assert abs(cases[4, 1, 1]["taken_uniform_ties"] / 4000 - (0.1 * 0.1 + 0.9 * 0.25)) < 0.04
    assert abs(cases[4, 1, 1]["taken_prior_ties"] / 4000 - 0.1) < 0.03


def test_frequency_counts_steps_into_the_goal():
    tables = goal_tables(np.array([[1, 0], [1, 1]], np.int32), 1, [0])
    certain = uniform_rows(tables, np.array([[1.0, 0.0], [0.5, 0.5]]))
    never = uniform_rows(tables, np.array([[0.0, 1.0], [0.5, 0.5]]))
    assert frequency(tables, certain, 1.0, 50, (0, "a")) == 50
    assert frequency(tables, never, 1.0, 50, (0, "a")) == 0


@pytest.mark.parametrize("kind", ["random", "lattice", "noise"])
def test_found_worlds_keep_to_the_bound(kind):
    cases = [found_case(kind, QUICK, (1, "test", kind, i), 3) for i in range(4)]
    cases = [case for case in cases if case]
    assert cases
    for case in cases:
        assert case["entering"] > 0
        assert case["below_states"] == case["below_percepts_pooled"] == 0
        assert case["least"] >= case["bound"] * (1 - 1e-12)
        assert (case["least_percepts"] < case["bound"] * (1 - 1e-12)) == (case["below_percepts"] > 0)
        assert case["expected"] >= case["least"]
