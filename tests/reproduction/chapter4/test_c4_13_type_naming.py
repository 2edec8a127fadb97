"""Measures of C4.13 on confusions made by hand."""

import numpy as np
import pytest

from reproduction.chapter4.ball_game.trials import BEAT
from reproduction.chapter4.c4_13_type_naming.run import numbers


def made():
    """Of 100 players of each size: 45 of b = 2 are taken for 5, 10 of b = 5 for 2, 12 of b = 10 for 20."""
    half = (100 * np.eye(6)).astype(int)
    half[0, :2], half[1, :2], half[2, 2:4] = [55, 45], [10, 90], [88, 12]
    return half


def test_measures_by_hand():
    half = made()
    found = numbers({"half": {BEAT: half.tolist()}}, {})
    assert found["ratio_2"].value == pytest.approx((55 + 45 * 2.5) / 100)
    assert found["ratio_5"].value == pytest.approx((90 + 10 * 0.4) / 100)
    assert found["worst_ratio_10_to_60"].value == pytest.approx(1.12)
    assert found["smallest_off_beyond_others"].value == pytest.approx(0.675 - 0.12)
    assert found["pairs_confused_more_often"].value == 0
    assert found["right_half"].value == pytest.approx(533 / 600)
    half[3, 3:5] = [40, 60]
    changed = numbers({"half": {BEAT: half.tolist()}}, {})
    assert changed["pairs_confused_more_often"].value == 1
    assert changed["worst_ratio_10_to_60"].value == pytest.approx(0.4 + 0.6 * 2)
