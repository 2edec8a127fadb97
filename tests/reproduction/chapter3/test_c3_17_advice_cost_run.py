"""How much is advised: the ceiling by hand, policies learnt so far, and watching at every κ at once."""

import json
from math import log

import numpy as np
import pytest

from lifelore.action.advice.advisor import Advisor
from lifelore.action.advice.goal_model import GoalModel
from reproduction.chapter3.advice.mazes import (
    errands_of,
    goal_models_of,
    maze_of,
    policy_of,
    thesis_advisor,
    walk,
)
from reproduction.chapter3.c3_17_advice_cost.run import (
    agent_policies,
    ceiling,
    greedy_policy,
    run_cell,
)
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C3.17").sizes["quick"])

CELL = {"loops": 0.1, "maze": 0}


def test_ceiling_by_hand():
    best = [
        [True, False, False, False],
        [True, True, False, False],
        [True, True, True, False],
        [True] * 4,
        [False] * 4,
    ]
    found = ceiling(GoalModel.from_best_actions(best))
    assert found == pytest.approx([log(4), log(2), log(4 / 3), 0, 0])


@pytest.mark.parametrize("alpha0", [0.01, 1.0, 100.0])
def test_an_agent_that_seems_an_expert_gains_less_than_the_ceiling_however_blurred_experts_are(alpha0):
    purpose = GoalModel.from_best_actions([[True, False, False, False]], alpha0=alpha0)
    blurred = -log((1 + alpha0) / (1 + 4 * alpha0))
    sure = Advisor([purpose], weights=[1, 1e-12])
    assert sure.consider(sure.watch(), 0).gain == pytest.approx(blurred, abs=1e-9)
    assert blurred < ceiling(purpose)[0] == pytest.approx(log(4))


def test_greedy_policy_by_hand():
    q = np.array([[0.0, 0.0, 0.0, 0.0], [3.0, 1.0, 3.0, 0.0]])
    found = greedy_policy(q, 0.2)
    assert found[0] == pytest.approx([0.25] * 4)
    assert found[1] == pytest.approx([0.45, 0.05, 0.45, 0.05])


@pytest.fixture(scope="module")
def cell():
    return run_cell(QUICK, CELL, 0)


def test_a_cell_is_plain_data_with_every_agent_told_and_watched(cell):
    assert json.loads(json.dumps(cell)) == cell
    assert len(cell["amounts"]) == 2 * 2 * (5 + 2)


def test_no_gain_is_above_the_ceiling_and_beyond_log_4_nobody_is_advised(cell):
    assert [c["above"] for c in cell["ceilings"]] == [0, 0]
    assert all(c["states"][0] == 1 and c["states"][-1] == 0 for c in cell["ceilings"])
    assert all(a["advised"][-1] == 0 for a in cell["amounts"])


def test_at_0_every_step_is_advised_where_experts_passed(cell):
    for entry in cell["amounts"]:
        assert entry["advised"][0] == entry["known"][0] <= entry["steps"][0]
        if not entry["heeds"]:
            assert entry["advised"] == sorted(entry["advised"], reverse=True)


def test_watching_once_is_watching_at_every_kappa(cell):
    maze = maze_of(QUICK, CELL, 0)
    entry = next(a for a in cell["amounts"] if (a["experts"], a["agent"], a["heeds"]) == ("walks", "bug", False))
    for k, kappa in enumerate(QUICK["kappas"]):
        advisor = thesis_advisor(QUICK, goal_models_of(QUICK, maze, "walks"), kappa)
        n_advised = 0
        for number, errand in enumerate(errands_of(maze, QUICK["tasks"])):
            alone = walk(
                maze, errand, policy_of(maze.world, "bug", errand), advisor, number, QUICK["max_steps"], False
            )
            n_advised += int(advisor.assess(alone.states, alone.actions).advise.sum())
        assert entry["advised"][k] == n_advised


def test_q_learning_that_found_nothing_yet_is_random_motion():
    maze = maze_of(QUICK, CELL, 0)
    errands = errands_of(maze, 2)
    settings = {**QUICK, "tasks": 2, "snapshots": [1], "max_episode_steps": 1}
    for policy, errand in zip(agent_policies(settings, maze)["q 1"], errands, strict=True):
        # One step that is not the last tells nothing: Q is 0 everywhere.
        assert policy == pytest.approx(policy_of(maze.world, "random", errand)[:, 0])
