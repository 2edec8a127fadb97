"""Claim C3.19: doubt and noise by hand, and measures from made-up runs."""

import numpy as np
import pytest

from reproduction.chapter3.c3_19_acquired_features.run import ACQUIRED, ALL, PLAIN, START, doubt, readings
from reproduction.engine.registry import claim_of

SETTINGS = claim_of("C3.19").sizes["quick"]
FOUR = ["PosUM", "PosML", "PosMR", "PosDM"]


def test_measures_by_hand():
    def learner(reward, bits):
        return {"rewards": [reward - 1, reward + 1], "entropy": bits, "surprise": 2 * bits}

    results = [
        {
            "optimal": 100.0,
            PLAIN: {"rewards": [0.0, 0.0]},
            ALL: learner(32.0, 1.0),
            START: [learner(10.0, 2.0), learner(12.0, 2.0)],
            ACQUIRED: [learner(30.0 + run, 1.2), learner(11.0, 1.9)],
            "features": [[*FOUR, "Items", *["Noise2"][:run]], []],
        }
        for run in range(3)
    ]
    only = {**SETTINGS, "start": ["phi1"], "least": SETTINGS["least"][:2]}
    found, _ = claim_of("C3.19").measured(only, results)
    assert found["reward_gain"].value == 21.0
    assert found["entropy_fall"].value == pytest.approx(0.8)
    assert found["surprise_fall"].value == pytest.approx(1.6)
    assert found["acquired_minus_all"].value == pytest.approx(-0.01)
    assert found["least_share_of_four"].value == 1.0
    assert found["largest_share_of_noise"].value == pytest.approx(2 / 3)
    (first, at_first), (second, at_second) = readings(only, results)
    assert (first["least"], second["least"]) == (0.1, 0.05)
    assert (at_first["reward_gain"].value, at_second["reward_gain"].value) == (21.0, -1.0)


def test_doubt_by_hand():
    probs = np.array([[0.5, 0.5], [0.25, 0.75], [0.1, 0.9]])
    best = np.array([[True, True], [True, False], [False, False]])
    h = 0.25 * 2 - 0.75 * np.log2(0.75)
    assert doubt(probs, best) == pytest.approx(((1 + h) / 2, (1 + 2) / 2))
