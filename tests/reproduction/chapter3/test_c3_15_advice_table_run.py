"""A cell of C3.15: every agent under every advisor."""

import json

import numpy as np
import pytest

from lifelore.action.advice.advisor import BETTER
from reproduction.chapter3.advice.mazes import AGENTS, goal_models_of, maze_of
from reproduction.chapter3.c3_15_advice_table.run import better_advisor, run_cell
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C3.15").sizes["quick"])
CELL = {"loops": 0.1, "maze": 0}


@pytest.fixture(scope="module")
def cell():
    return run_cell(QUICK, CELL, 0)


def test_a_cell_has_every_agent_under_every_advisor(cell):
    assert json.loads(json.dumps(cell)) == cell
    ways = [(e["experts"], e["way"], e["agent"]) for e in cell["walks"]]
    # Nobody; three advisors for two kinds of experts; and at the default, experts of other goals alone.
    assert len(set(ways)) == len(ways) == 5 * (1 + 3 * 2 + 1)
    assert all(len(e["reached"]) == QUICK["tasks"] for e in cell["walks"])
    assert [one["experts"] for one in cell["learners"]] == [None, "walks", "policies"]


def test_nobody_advises_the_unadvised_and_the_better_advisor_keeps_to_its_share(cell):
    for entry in cell["walks"]:
        shares = np.array(entry["advised"]) / np.array(entry["steps"])
        assert entry["way"] != "none" or not shares.any()
        assert entry["way"] in ("none", "thesis") or shares.max() <= 0.4
    assert any(sum(entry["advised"]) for entry in cell["walks"] if entry["way"] == "better")


def test_a_building_has_every_agent_without_advice_and_with_each_alpha0():
    small = {**QUICK, "tasks": 2, "q_learning": {**QUICK["q_learning"], "tasks": 1, "episodes": 20}}
    for place, n_alpha0 in ((0, 1 + 2), (5, 1)):
        found = run_cell(small, {"building": place, "maze": 0}, 0)
        assert json.loads(json.dumps(found)) == found
        assert len(found["rewards"]) == (len(AGENTS) + 1) * (1 + n_alpha0)
        alone = {r["agent"]: r["reward"] for r in found["rewards"] if r["alpha0"] is None}
        assert alone["optimal"] == 1000
        assert 0.4 < found["walls"] < 0.7


def test_the_defaults_building_is_the_grids_maze(cell):
    rewards = run_cell(QUICK, {"building": 0, "maze": 0}, 0)["rewards"]
    for alpha0, experts, way in ((None, None, "none"), (0.0, "walks", "thesis")):
        mine = {r["agent"]: r["reward"] for r in rewards if r["alpha0"] == alpha0}
        for entry in cell["walks"]:
            if (entry["experts"], entry["way"]) == (experts, way):
                assert mine[entry["agent"]] == pytest.approx(1000 * np.mean(entry["reached"]))


def test_optimal_agents_arrive_unadvised(cell):
    alone = next(e for e in cell["walks"] if (e["way"], e["agent"]) == ("none", "optimal"))
    assert alone["reached"] == [1] * QUICK["tasks"]


def test_the_better_advisor_knows_explorers_only_if_asked_to():
    maze = maze_of(QUICK, CELL, 0)
    purposes = goal_models_of(QUICK, maze, "walks")
    knowing, plain_one = (better_advisor(QUICK, maze.world, purposes, explorers=e) for e in (True, False))
    # Eight experts; three explorers and a bug for each goal, or Uniform.
    assert (len(knowing.guide.log_prior), len(plain_one.guide.log_prior)) == (8 + 3 + 8, 8 + 1)
    assert knowing.settings.share == BETTER.share == 0.4
    assert (knowing.settings.kappa, knowing.settings.window) == (0.5, 300)
