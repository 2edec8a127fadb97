"""Claim C3.18: P(M₁ | H) of own steps, curves by blocks of steps, and measures, by hand."""

import numpy as np
import pytest

from lifelore.action.advice.advisor import Advisor
from reproduction.chapter3.advice.advised_walk import Walk
from reproduction.chapter3.c3_18_normalcy import run
from reproduction.chapter3.c3_18_normalcy.run import block_curve, own_normalcy, readings
from reproduction.engine.registry import claim_of
from tests.action.advice.goal_models import goal_model_of


def walked(p_normal, advised, reached=False, actions=None):
    n = len(p_normal)
    actions = np.zeros(n, np.int8) if actions is None else np.array(actions, np.int8)
    arrays = (np.zeros(n, np.int32), actions, np.array(advised, bool), np.array(p_normal), np.zeros(n))
    return Walk(*arrays, reached=reached, reward=1000.0 * reached)


def test_own_steps_by_hand():
    # One count and α⁰ = 0.1: P(0 | M₁) = 1.1/1.2, P(1 | M₁) = 0.1/1.2, against 1/2.
    advisor = Advisor.of_thesis([goal_model_of([[True, False]])])
    after = (0.1 / 1.2) / (0.1 / 1.2 + 0.5)
    # It chose 1, was advised 0 twice, and chose 1: P(M₁ | H) before each step is 1/2, then that after one step.
    found = own_normalcy(advisor, walked([0.5] * 4, [0, 1, 1, 0], actions=[1, 0, 0, 1]))
    assert found == pytest.approx((0.5 + 3 * after) / 4)
    # Advised steps count where they are not left out: then it seems an expert.
    assert advisor.assess([0] * 4, [1, 0, 0, 1]).p_normal[-1] > after


def test_curves_by_blocks_by_hand(monkeypatch):
    monkeypatch.setattr(run, "BLOCKS", 3)
    long, short = walked([0.5, 0.7, 0.1, 0.3], [0] * 4), walked([0.2, 0.4, 0.6], [0] * 3, reached=True)
    found = block_curve([long, short], 6)
    assert found["x"] == [2, 4, 6]
    assert found["normal"] == [pytest.approx(1.8 / 4, abs=1e-4), pytest.approx(1.0 / 3, abs=1e-4), None]
    assert found["reward"] == [0, 500, 500]


def test_numbers_by_hand():
    settings = {**claim_of("C3.18").sizes["quick"], "loops": [0.1], "experts": ["walks", "trips"], "alpha0": [0.1]}
    gains = {"random": 0.1, "avoid": 0.2, "left": 0.0, "bug": 0.3}
    others = dict.fromkeys(gains, 0.05)
    results = [{"loops": 0.1, "gains": [gains, others], "own": dict.fromkeys(gains, 0.02)}] * 3
    found, _ = claim_of("C3.18").measured(settings, results)
    assert (found["gain_bug"].value, found["gain_own"].value) == (0.3, 0.02)
    assert found["gain"].value == pytest.approx(0.15)
    (_, same), (cell, other) = readings(settings, results)
    assert same["gain_left"].value == 0
    assert (cell["experts"], other["gain_left"].value) == ("trips", pytest.approx(0.05))
