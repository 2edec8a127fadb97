"""C2.10: one scene in full, and the shares by hand."""

import pytest

from reproduction.chapter2.c2_10_ball_on_block.run import BALL, BLOCK, findings, measure, readings
from reproduction.chapter2.scenes.arranged_scenes import arranged

pytest.importorskip("mujoco")


def test_one_scene_is_told_as_in_the_figure():
    found = findings(arranged("ball-on-block", 0, 0).cloud, BALL, BLOCK)
    assert found == {"said": "on(A, B), on(B, G)", "right": True, "two_points": True}


def test_measures_by_hand():
    good = {"right": True, "two_points": True}
    results = [
        {"camera": "stereo", "scenes": [good, {**good, "two_points": False}], "examples": []},
        {"camera": "kinect", "scenes": [{**good, "right": False}], "examples": []},
    ]
    found = measure({}, results)
    assert found["predicates_right"].value == 1.0
    assert found["two_points_of_the_block"].value == 0.5
    assert found["predicates_right_of_real"].n == 0
    assert [numbers["predicates_right"].value for _, numbers in readings({}, results)] == [1.0, 0.0]
