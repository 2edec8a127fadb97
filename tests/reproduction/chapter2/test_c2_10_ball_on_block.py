"""C2.10: one scene in full, and the shares by hand."""

import pytest

from reproduction.chapter2.c2_10_ball_on_block.measure import measure
from reproduction.chapter2.c2_10_ball_on_block.run import BALL, BLOCK, findings
from reproduction.chapter2.scenes.arranged_scenes import arranged

pytest.importorskip("mujoco")


def test_one_scene_is_told_as_in_the_figure():
    found = findings(arranged("ball-on-block", 0, 0).cloud, BALL, BLOCK)
    assert found["said"] == "on(A, B), on(B, G)"
    assert found["right"]
    assert found["points"] == [1, 1]
    assert found["near_points"] == found["upper_points"] + 1  # the ground below the ball


def test_measures_by_hand():
    good = {"said": "", "right": True, "points": [1, 1], "upper_points": 1, "near_points": 2}
    results = [
        {"camera": "kinect", "scenes": [good, {**good, "points": [2, 1]}], "examples": []},
        {"camera": "stereo", "scenes": [{**good, "right": False}], "examples": []},
    ]
    found = measure({}, results)
    assert found["predicates_right_kinect"].value == 1.0
    assert found["two_points_of_the_lower_kinect"].value == 0.5
    assert found["predicates_right_stereo"].value == 0.0
    assert found["one_point_of_the_upper_of_all_near_pairs_kinect"].value == 0.0
    assert found["predicates_right_real"].n == 0
