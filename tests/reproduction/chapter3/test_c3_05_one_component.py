"""Gains of C3.5 and C3.6 from made-up sequences, by hand, and a short sequence."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from reproduction.chapter3.c3_05_one_component.run import Sequences, grid_of
from reproduction.engine.registry import claim_of

SETTINGS = {**claim_of("C3.5").settings("quick"), "prior_tasks": 6, "late": 2, "components": [1]}
GRID = grid_of(SETTINGS)
N = np.arange(7)


def sequence(run, k=1, per_task=10.0):
    """Gains of run r: 0, then `per_task` n + r. From scratch 200 are left to gain."""
    rewards = {"uniform": np.full(7, -100.0), "learnt": -100 + per_task * N + run * (N > 0)}
    found = [
        {"method": method, **cell, "rewards": of.tolist()}
        for method, of in rewards.items()
        for cell in GRID.cells_of(method)
    ]
    # The sixth task was met before, the last one is new, save in run 3.
    seen = [False] * 5 + [True, run == 3]
    return {"components": k, "run": run, "found": found, "optimal": [100.0] * 7, "seen": seen, "met": 3 + run % 2}


RESULTS = [sequence(run) for run in range(4)]


def test_gains_by_hand():
    seen = np.array([result["seen"] for result in RESULTS])
    found = Sequences.of(RESULTS, GRID, GRID.default).numbers(SETTINGS, seen)
    assert found["gain_late"].value == pytest.approx(56.5 / 200)
    assert found["growth"].value == pytest.approx(40 / 200)
    # New: 60 + r in runs 0 … 2.
    assert found["gain_new"].value == pytest.approx(61 / 200)
    assert found["gain_new"].n == 3


def test_four_components_less_one_by_hand():
    settings = {**SETTINGS, "components": [4, 1]}
    results = [sequence(run, 4, per_task=2.0) for run in range(4)] + RESULTS
    found, _ = claim_of("C3.6").measured(settings, results)
    # Late gains are 11 + r and 55 + r, of 200 each.
    assert found["gain_less_one_component"].value == pytest.approx(-44 / 200)
    assert found["share_of_tasks_met"].value == pytest.approx(3.5 / 126)
    assert found["late_tasks_seen"].value == pytest.approx((3 * 0.5 + 1) / 4)


def test_a_second_number_of_components_is_asked_for():
    with pytest.raises(InputError, match="components must be two numbers"):
        claim_of("C3.6").settings("quick", {"components": [4]})
