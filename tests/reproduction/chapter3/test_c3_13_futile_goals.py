"""Worlds of C3.13 by hand: the constructed worst case, its frequency, what is below the bound, and measures."""

import numpy as np
import pytest

from lifelore.action.search.domain_reduction import domain_futile_states
from reproduction.chapter3.c3_13_futile_goals.run import (
    best_in,
    constructed,
    constructed_cases,
    found_case,
    goal_tables,
    measure,
)
from reproduction.engine.registry import claim_of

QUICK = claim_of("C3.13").sizes["quick"]
SETTINGS = {**QUICK, "draws": 4000, "actions": [4, 2], "alpha0": [0.5], "tasks": [1, 3]}


def test_the_constructed_world_by_hand():
    # Junction 0, room 1, goals 2 and 3, new goal 4; action 1 of three leads to it.
    world = constructed(3, 2, 1)
    assert world.follow.tolist() == [[1, 4, 1], [2, 2, 2], [3, 3, 3], [0, 0, 0], [0, 0, 0]]
    assert (world.goals, world.new_goal) == ([2, 3], 4)
    tasks = [goal_tables(world.follow, goal, [0]) for goal in world.goals]
    policies = [best_in(task, goal) for task, goal in zip(tasks, world.goals, strict=True)]
    for best in policies:
        assert best[0].tolist() == [True, False, True]
    assert np.flatnonzero(domain_futile_states(tasks, policies)).tolist() == [4]


def test_constructed_cases_by_hand():
    cases = {(c["actions"], c["tasks"]): c for c in constructed_cases(SETTINGS, 0, 0)}
    assert set(cases) == {(actions, tasks) for actions in (2, 4) for tasks in (0, 1, 3)}
    # 0.5 / (3 (1 + 0.5) + 0.5) and 0.5 / (1 (3 + 0.5) + 0.5).
    assert cases[4, 1]["formula"] == cases[4, 1]["prior"] == pytest.approx(0.1)
    assert cases[2, 3]["formula"] == cases[2, 3]["prior"] == pytest.approx(1 / 8)
    assert cases[4, 0]["prior"] == 0.25
    for case in cases.values():
        expected = 4000 * case["formula"]
        assert abs(case["taken"] - expected) < 5 * np.sqrt(expected)


@pytest.mark.parametrize("kind", ["random", "lattice", "noise"])
def test_found_worlds_keep_to_the_bound(kind):
    cases = [found_case(kind, QUICK, (1, "test", kind, i), 3) for i in range(4)]
    cases = [case for case in cases if case]
    assert cases
    for case in cases:
        assert case["entering"] > 0
        assert case["below"] == 0
        assert case["least"] >= 1 - 1e-12


def test_numbers_by_hand():
    # Eq. 3.6 for two actions and α⁰ 1: 1/2, 1/3 and 1/12.
    settings = {**QUICK, "draws": 1200, "actions": [2], "alpha0": [1.0], "kinds": ["random"], "found_tasks": [1]}
    cases = [
        {"actions": 2, "alpha0": 1.0, "tasks": n, "formula": p, "prior": p, "taken": taken}
        for n, p, taken in ((0, 1 / 2, 600), (1, 1 / 3, 400), (10, 1 / 12, 110))
    ]
    world = {"kind": "random", "tasks": 1, "entering": 4, "below": 1, "least": 0.8}
    results = [{"constructed": cases, "found": [world]}] * 3
    found = measure(settings, results)
    assert found["prior_error"].value == 0
    assert found["frequency_ratio"].value == pytest.approx((1 + 1.1) / 2)
    assert found["frequency_ratio_no_task"].value == pytest.approx(1)
    assert found["slope"].value == pytest.approx(np.log10(110 / 400))
    assert found["share_below"].value == 0.25
