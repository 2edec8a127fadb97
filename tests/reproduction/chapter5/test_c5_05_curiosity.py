"""C5.5: needed orders and measures by hand, and a tiny run."""

import json

import numpy as np
import pytest

from reproduction.chapter5.c5_05_curiosity.measure import auc_over_lives, measure, orders_needed, rows
from reproduction.chapter5.c5_05_curiosity.run import CHOOSERS, late_lives, run_cell
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C5.5")
SMALL = {
    **CLAIM.sizes["quick"], "lives": 1, "lived": 3, "spare": 2, "every": 1, "tests": 2, "late_lives": 1,
    "orders": 5, "arrival": 3,
}  # fmt: skip
LATE = {
    "part": "late type", "known_scores": [0.0, 1.0], "late_scores": [2.0], "false_alarms": [False, True],
    "noticed": True, "learnt": True, "recognised_after": 2, "again": True,
}  # fmt: skip


def test_orders_needed_by_hand():
    settings = {"spare": 12, "every": 4}
    missed = np.array([10.0, 6.0, 2.0, 1.0])
    assert orders_needed(settings, missed, 10.0) == 0
    assert orders_needed(settings, missed, 8.0) == pytest.approx(2)
    assert orders_needed(settings, missed, 4.0) == pytest.approx(6)
    assert orders_needed(settings, missed, 0.0) == 12


def test_measures_by_hand():
    settings = {"spare": 8, "every": 4}
    curves = {"uniform": [10.0, 5.0, 0.0], "curious": [10.0, 2.0, 0.0], "learnable": [10.0, 10.0, 10.0]}
    results = [{"part": "spare time", "life": life, **curves} for life in range(3)] + [LATE, LATE | {"life": 1}]
    found = measure(settings, results)
    # Four fifths of the gain of 10 are reached at 2 points missed: after 6.4 uniform and 4 curious orders.
    assert found["curious_over_uniform_episodes"].value == pytest.approx(4 / 6.4)
    assert found["learnable_over_uniform_episodes"].value == pytest.approx(8 / 6.4)
    assert found["curious_less_uniform"].value == 0
    assert (found["late_type_auc"].value, found["late_type_learnt"].value) == (1.0, 1.0)
    assert (found["false_alarms"].value, found["recognised_soon"].value) == (0.5, 1.0)


def test_area_under_the_curve_over_lives():
    assert auc_over_lives(late_lives([LATE] * 3)).ci95 == (1.0, 1.0)
    lives = late_lives([LATE | {"late_scores": [score]} for score in (2.0, 2.0, 2.0, 0.5)])
    found = auc_over_lives(lives)
    # Against known scores 0 and 1 a late score of 2 is always above, one of 0.5 half the time.
    assert found.value == pytest.approx((3 + 0.5) / 4)
    # All four drawn lives are the last one in one draw of 256, and none is in a third of them.
    assert found.ci95 == (0.625, 1.0)


def test_a_tiny_run():
    results = [json.loads(json.dumps(run_cell(SMALL, cell, 1))) for cell in CLAIM.cells(SMALL)]
    assert {condition.measure for condition in CLAIM.predicate.conditions} <= set(measure(SMALL, results))
    spare, late = results
    assert {len(spare[name]) for name in CHOOSERS} == {3}
    # Before spare time begins, all choosers know the same.
    assert len({spare[name][0] for name in CHOOSERS}) == 1
    assert len(late["late_scores"]) == 1
    assert [row["chooser"] for row in rows(SMALL, results)] == list(CHOOSERS)
