"""C5.7: scenes are what they are called, a scene is poked, and measures by hand."""

import numpy as np
import pytest

from reproduction.chapter5.c5_07_poking.run import measures_of, outcome

pytest.importorskip("mujoco", reason="needs the extra sim")


def test_an_outcome_by_hand():
    truth, before = np.array([2, 2, 3, 3, 4, 4]), np.array([2, 2, 2, 2, 3, 4])
    assert outcome(truth, before, truth) == [[2, 0.5, 1.0], [2, 0.5, 1.0], [2, 0.5, 1.0]]


def test_measures_by_hand():
    scenes = [[[10, 0.4, 0.8], [30, 0.6, 0.6]], [[20, 0.9, 0.4]]]
    found = {name: number.value for name, number in measures_of(scenes).items()}
    assert found["overlap_gain"] == pytest.approx((4 + 0 - 10) / 60)
    assert found["found_before"] == found["found_after"] == pytest.approx(2 / 3)
    assert (found["found_gain"], found["corrected"], found["spoiled"]) == (0.0, 1.0, 0.5)
