"""Explorers on errands: readings of P(M₁ | H) by hand, and a whole cell of C3.18."""

import json

import numpy as np
import pytest

from lifelore.action.advice.advised_walk import Walk
from lifelore.action.advice.advisor import Advisor
from lifelore.action.advice.goal_model import GoalModel
from reproduction.chapter3.c3_18_normalcy.run import (
    block_curve,
    own_normalcy,
    run_cell,
    unadvised_normalcy,
)
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C3.18").sizes["quick"])

CELL = {"loops": 0.1, "maze": 0}


def walked(p_normal, advised, reached=False, actions=None):
    n = len(p_normal)
    actions = np.zeros(n, np.int8) if actions is None else np.array(actions, np.int8)
    arrays = (np.zeros(n, np.int32), actions, np.array(advised, bool), np.array(p_normal), np.zeros(n))
    return Walk(*arrays, reached=reached, reward=1000.0 * reached)


def test_unadvised_steps_by_hand():
    assert unadvised_normalcy(walked([0.5, 0.1, 0.9, 0.3], [0, 1, 1, 0])) == pytest.approx(0.4)
    assert unadvised_normalcy(walked([0.5, 0.1], [1, 1])) is None


def test_own_steps_by_hand():
    # One count and α⁰ = 0.1: P(0 | M₁) = 1.1/1.2, P(1 | M₁) = 0.1/1.2, against 1/2.
    advisor = Advisor.of_thesis([GoalModel.from_best_actions([[True, False]])])
    after = (0.1 / 1.2) / (0.1 / 1.2 + 0.5)
    # It chose 1, was then told 0 twice, and chose 1: P(M₁ | H) before each step is 1/2, then that after one step.
    found = own_normalcy(advisor, walked([0.5] * 4, [0, 1, 1, 0], actions=[1, 0, 0, 1]))
    assert found == pytest.approx((0.5 + 3 * after) / 4)
    # What was told counts where it is not left out: then it seems an expert.
    all_steps = advisor.assess([0] * 4, [1, 0, 0, 1]).p_normal
    assert all_steps[-1] > after


def test_curves_by_blocks_by_hand():
    long, short = walked([0.5, 0.7, 0.1, 0.3], [0] * 4), walked([0.2, 0.4, 0.6], [0] * 3, reached=True)
    found = block_curve([long, short], 3, 2)
    assert found["p"] == pytest.approx([1.2 + 0.6, 0.4 + 0.6, 0])
    assert found["n"] == [4, 3, 0]
    assert found["reached"] == [0, 1, 1]


def test_normalcy_cell_is_plain_and_an_unadvised_walk_reads_alike_every_way():
    found = run_cell(QUICK, CELL, 0)
    assert json.loads(json.dumps(found)) == found
    assert len(found["explorers"]) == 2 * 4
    for entry in found["explorers"]:
        for number, share in enumerate(entry["advised_share"]):
            if not share:
                readings = [entry[key][number] for key in ("alone", "told", "own", "unadvised")]
                assert readings == pytest.approx([readings[0]] * 4)
