"""Detections and relations as message fields: turns checked with SciPy, names and times by hand."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lifelore.bridges.detection3d import detection_array, quaternion, relation_array, transform

QUARTER = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]
"""Axes of a quarter turn about z."""
DOCUMENT = {
    "frame": {"name": "eye", "stamp": 1_700_000_000.25},
    "objects": [
        {"id": 2, "box_camera": {"centre": [1, 2, 3], "axes": QUARTER, "size": [3, 2, 1]}},
        {"id": 3, "box_camera": {"centre": [0, 0, 1], "axes": np.eye(3), "size": [1] * 3}, "cut_confidence": 0.7},
    ],
    "relations": [
        {"a": 3, "b": 2, "relation": "on", "confidence": 0.9, "gap": 0.01, "stated": True},
        {"a": 2, "b": "table", "relation": "on", "confidence": 0.4, "gap": None, "stated": False},
        {"a": 2, "b": 4, "relation": "none", "confidence": 0.9, "gap": 0.1, "stated": True},
    ],
}  # fmt: skip


@pytest.mark.parametrize("seed", range(20))
def test_a_quaternion_is_that_of_scipy(seed):
    turn = Rotation.random(rng=np.random.default_rng(seed))
    found = quaternion(turn.as_matrix().T.tolist())
    same = turn.as_quat()
    assert list(found.values()) == pytest.approx(same * np.sign(same @ list(found.values())))


def test_a_motion_becomes_a_transform():
    motion = np.eye(4)
    turn = Rotation.from_euler("zyx", [0.3, -0.2, 0.9])
    motion[:3, :3], motion[:3, 3] = turn.as_matrix(), [1, 2, 3]
    found = transform(motion.tolist())
    assert found["translation"] == {"x": 1, "y": 2, "z": 3}
    assert Rotation.from_quat(list(found["rotation"].values())).as_matrix() == pytest.approx(turn.as_matrix())


def test_each_object_is_a_detection_in_the_frame_of_the_camera():
    found = detection_array(DOCUMENT)
    assert found["header"] == {"stamp": {"sec": 1_700_000_000, "nanosec": 250_000_000}, "frame_id": "eye"}
    first, second = found["detections"]
    assert (first["id"], second["id"]) == ("2", "3")
    assert first["header"] == found["header"]
    assert first["bbox"]["center"]["position"] == {"x": 1, "y": 2, "z": 3}
    half = math.sqrt(0.5)  # a quarter turn about z
    assert first["bbox"]["center"]["orientation"] == pytest.approx({"x": 0, "y": 0, "z": half, "w": half})
    assert first["bbox"]["size"] == {"x": 3, "y": 2, "z": 1}
    scores = [one["results"][0]["hypothesis"]["score"] for one in found["detections"]]
    assert scores == [1.0, 0.7]
    assert detection_array(DOCUMENT, {"frame_id": "map"})["detections"][0]["header"] == {"frame_id": "map"}


def test_relations_have_the_names_of_the_detections():
    upper, lower = relation_array(DOCUMENT)["relations"]
    assert upper == {"a": "3", "b": "2", "relation": "on", "confidence": 0.9, "gap": 0.01, "stated": True}
    assert (lower["b"], lower["stated"]) == ("table", False)
    assert math.isnan(lower["gap"])
