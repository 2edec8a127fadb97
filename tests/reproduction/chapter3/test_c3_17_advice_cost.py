"""Claim C3.17: policies learnt so far, the ceiling of κ, and measures from made-up mazes, by hand."""

import numpy as np
import pytest

from reproduction.chapter3.c3_17_advice_cost.run import EARLY, LATE, readings, rows, steepest_rise
from reproduction.engine.learning_run import greedy_probs
from reproduction.engine.registry import claim_of

SETTINGS = {
    **claim_of("C3.17").sizes["quick"], "kappas": [0.5, 1.4], "loops": [0.1], "experts": ["walks"],
    "alpha0": [0.1], "heeds": [True, False],
}  # fmt: skip


def test_greedy_policy_by_hand():
    q = np.array([[0.0, 0.0, 0.0, 0.0], [3.0, 1.0, 3.0, 0.0]])
    found = greedy_probs(q, 0.2)
    assert found[0] == pytest.approx([0.25] * 4)
    assert found[1] == pytest.approx([0.45, 0.05, 0.45, 0.05])


def test_the_steepest_rise_by_hand():
    assert steepest_rise(np.array([[60.0, 20, 33], [60, 22, 31]])).tolist() == [13, 9]
    assert steepest_rise(np.array([[60.0, 20, 10], [60, 22, 11]])).tolist() == [0, 0]


def test_numbers_by_hand():
    falling = {
        "random": [80, 40, 0], "avoid": [60, 20, 0], "left": [60, 10, 0], "bug": [60, 30, 5],
        "optimal": [50, 2, 0], EARLY: [80, 41, 0], LATE: [50, 5, 0],
    }  # fmt: skip
    heeded = falling | {"bug": [60, 20, 33]}
    results = [
        {
            "loops": 0.1,
            "amounts": [falling, heeded],
            "drawn": {"bug": [[50, 70], [20, 40], [0, 10]]} if not n else {},
        }
        for n in range(3)
    ]
    found, _ = claim_of("C3.17").measured(SETTINGS, results)
    assert found["least_fall"].value == 50
    assert found["largest_rise"].value == 0
    assert (found["early_minus_random"].value, found["late_minus_optimal"].value) == (1, 3)
    (cell, same), (other, rising) = readings(SETTINGS, results)
    assert (cell["heeds"], other["heeds"]) == (True, False)
    assert same["least_fall"] == found["least_fall"]
    assert (rising["least_fall"].value, rising["largest_rise"].value) == (27, 13)
    assert rows(SETTINGS, results) == [{"curve_of": "bug", "mean": [60, 30, 5], "deviation": [10, 10, 5]}]
