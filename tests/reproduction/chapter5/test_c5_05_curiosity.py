"""C5.5: needed orders, signs and measures by hand, and a short life with a late type."""

from types import SimpleNamespace

import numpy as np
import pytest

from reproduction.chapter5.c5_05_curiosity.run import SIGNS, auc_over_lives, measure, orders_needed, signs

LATE = {"part": "late type", "known": [[0.0, 0.5, 0.0], [1.0, 0.5, 1.0]], "late": [0.5, 0.5, 2.0], "learnt": True}


def test_orders_needed_by_hand():
    missed = np.array([10.0, 6.0, 2.0, 1.0])
    assert orders_needed(4, missed, 10.0) == 0
    assert orders_needed(4, missed, 8.0) == pytest.approx(2)
    assert orders_needed(4, missed, 4.0) == pytest.approx(6)
    assert orders_needed(4, missed, 0.0) == 12


def test_measures_by_hand():
    curves = {"uniform": [10.0, 5.0, 0.0], "curious": [10.0, 2.0, 0.0]}
    results = [{"part": "spare time", "life": life, **curves} for life in range(3)] + [LATE, LATE]
    found = measure({"span": 4}, results)
    # Four fifths of the gain of 10 are reached at 2 points missed: after 6.4 uniform and 4 curious orders.
    assert found["curious_over_uniform_orders"].value == pytest.approx(4 / 6.4)
    assert (found["spread_auc"].value, found["alarm_auc"].value) == (0.5, 1.0)
    assert found["late_type_learnt"].value == 1.0


def test_area_under_the_curve_over_lives():
    assert auc_over_lives([LATE] * 3, "alarm").ci95 == (1.0, 1.0)
    assert auc_over_lives([LATE] * 3, "mean spread").value == 0.5  # ties
    lives = [{**LATE, "late": [0.0, 0.0, score]} for score in (2.0, 2.0, 2.0, 0.5)]
    found = auc_over_lives(lives, "alarm")
    # Against known scores 0 and 1 a late score of 2 is always above, one of 0.5 half the time.
    assert found.value == pytest.approx((3 + 0.5) / 4)
    # All four drawn lives are the last one in one draw of 256, and none is in a third of them.
    assert found.ci95 == (0.625, 1.0)


def test_signs_leave_the_unknown_type_out():
    beliefs = ([0.2, 0.2, 0.6], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    decisions = [[SimpleNamespace(belief=np.array(belief))] for belief in beliefs]
    found = dict(zip(SIGNS, signs(SimpleNamespace(decisions=decisions, alarm_score=3.0)), strict=True))  # type: ignore[arg-type]
    # An even belief in two types has log 2 nats, as has one that believes in none of them.
    assert found["spread at the end"] == pytest.approx(np.log(2), abs=1e-5)
    assert found["mean spread"] == pytest.approx(2 / 3 * np.log(2), abs=1e-5)
    assert found["alarm"] == 3.0
