"""The JSON document: its keys, finite numbers, names, and that it reads back."""

import json
from dataclasses import replace

import numpy as np
import pytest

from lifelore.core.cloud_origin import CloudOrigin, SensorFrame
from lifelore.perception.scene_json import scene_document


def document(scene, **options):
    return json.loads(json.dumps(scene_document(scene, **options), allow_nan=False))


def test_every_key_of_the_contract(make_scene, box, meet):
    clouds = {2: box([0, 0, 0], [0.1, 0.05, 0.02]), 30: box([0, 0, 0.02], [0.1, 0.05, 0.04])}
    parts = [meet(2, 30, [[0.01, 0, 0.02], [0.09, 0, 0.02]]), meet(2, 1, [[0.05, 0, 0]])]
    scene = make_scene(clouds, parts, [(30, 2, "on", 0.75), (2, 1, "on", 0.5)])
    found = document(scene, seconds=0.25)
    keys = ["frame", "objects", "relations", "facts", "unknown", "holes", "contact_edges", "seconds"]
    assert list(found) == keys
    below, above = found["objects"]
    assert [below["id"], above["id"]] == [2, 30]
    assert below["n_points"] == len(clouds[2])
    assert np.allclose(below["centroid"], [0.05, 0.025, 0.01])
    assert [c["other"] for c in below["contact_points"]] == [30, 30, "table"]
    assert below["contact_points"][0]["xyz"] == [0.01, 0, 0.02]
    assert {"xyz", "normal", "extent", "strength"} <= set(below["contact_points"][0])
    assert above["edges"] == [[0, 1]]
    both = {f"{key}{frame}" for key in ("xyz", "approach", "closing") for frame in ("", "_camera")}
    assert {"kind", "width", *both} == set(above["grasp_seeds"][0])
    assert above["box"]["size"] == above["box_camera"]["size"] == pytest.approx([0.1, 0.05, 0.02])
    assert [above["top"], above["support"], below["support"]] == pytest.approx([0.04, 0.02, 0])
    assert above["colour"] is None
    assert found["relations"] == [
        {"a": 30, "b": 2, "relation": "on", "confidence": 0.75, "gap": 0, "stated": True},
        {"a": 2, "b": "table", "relation": "on", "confidence": 0.5, "gap": 0, "stated": True},
    ]
    assert {"on(30, 2)", "on(2, table)", "clear(30)", "supports*(2, 30)", "ec(table, 2)"} <= set(found["facts"])
    assert len(found["facts"]) == len(set(found["facts"]))
    assert found["holes"] == []
    assert found["seconds"] == 0.25


def test_places_are_in_the_frame_of_the_camera_too(make_scene, box, meet):
    made = make_scene({2: box([0, 0, 0], [0.1, 0.05, 0.02])}, [meet(2, 1, [[0.05, 0, 0]])])
    # The camera stands at (1, 2, 3); its x is the scene's y, its y the scene's -x, its z the scene's z.
    pose = np.array([[0.0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
    colours = np.tile(np.array([10, 20, 31], np.uint8), (len(made.cloud.points), 1))
    origin = CloudOrigin(pose, SensorFrame("eye", 7.5), np.arange(len(colours))[::-1].copy())
    found = document(replace(made, cloud=replace(made.cloud, origin=origin, colours=colours)), with_masks=True)
    assert (found["frame"]["name"], found["frame"]["stamp"]) == ("eye", 7.5)
    assert found["frame"]["scene_from_camera"] == pose.tolist()
    assert np.allclose(pose @ found["frame"]["camera_from_scene"], np.eye(4))
    (one,) = found["objects"]
    assert one["colour"] == [10, 20, 31]
    # x: 0.025 - 2, y: -(0.05 - 1), z: 0.01 - 3
    assert one["centroid_camera"] == one["box_camera"]["centre"] == pytest.approx([-1.975, 0.95, -2.99])
    assert one["box_camera"]["axes"][0] == [0, -1, 0]
    (contact,) = one["contact_points"]
    assert contact["xyz_camera"] == pytest.approx([-2, 0.95, -3])
    assert contact["normal_camera"] == contact["normal"] == [0, 0, 1]
    # The first point is the table's; the object's rows in the source count down to 0.
    assert one["points"] == list(range(len(colours) - 2, -1, -1))


def test_a_hole_names_its_contact_points(make_scene, box, meet):
    legs = [box([low, 0, 0], [low + 0.04, 0.05, 0.08]) for low in (0, 0.16)]
    clouds = {2: np.concatenate(legs), 3: box([0, 0, 0.08], [0.2, 0.05, 0.1])}
    clouds[2] = np.concatenate([clouds[2], box([0, 0, 0], [0.2, 0.05, 0.01])])
    found = document(make_scene(clouds, [meet(2, 3, [[0.02, 0, 0.08], [0.18, 0, 0.08]])]))
    (hole,) = found["holes"]
    assert hole["objects"] == [2, 3]
    assert hole["nodes"][0] == [2, 0]
    assert hole["size"] > hole["opening"] > 0
    assert len(hole["centre"]) == 3


def test_unknown_numbers_are_null_and_none_is_listed_but_no_fact(make_scene):
    point = np.zeros((1, 3))
    scene = make_scene({2: point, 3: point}, relations=[(2, 3, "none")])
    far = replace(scene, relations=(replace(scene.relations[0], gap=float("inf")),))
    found = document(far)
    assert found["relations"][0]["gap"] is None
    assert found["seconds"] is None
    assert not any(fact.startswith("none") for fact in found["facts"])


def test_an_empty_scene(make_scene):
    frame = {"name": None, "stamp": None, "scene_from_camera": np.eye(4).tolist()}
    assert document(make_scene({})) == {
        "frame": {**frame, "camera_from_scene": np.eye(4).tolist()},
        "objects": [],
        "relations": [],
        "facts": [],
        "unknown": [],
        "holes": [],
        "contact_edges": [],
        "seconds": None,
    }


def test_below_the_least_confidence_nothing_is_stated_and_nothing_follows(make_scene):
    points = {label: np.zeros((1, 3)) for label in (2, 3, 4)}
    rows = [(2, 1, "on", 0.9), (3, 2, "on", 0.6), (4, 1, "on", 0.9), (3, 4, "adjacent", 0.9), (2, 4, "none", 0.4)]
    scene = make_scene(points, relations=rows)
    found = document(scene, min_confidence=0.7)
    assert [one["stated"] for one in found["relations"]] == [True, False, True, True, False]
    assert "on(3, 2)" not in found["facts"]
    assert "supports*(2, 3)" not in found["facts"]
    # The relation of 2 and 4 is doubtful: neither apart nor touching.
    assert not any("(2, 4)" in fact for fact in found["facts"])
    assert {"on(2, table)", "adjacent(3, 4)"} <= set(found["facts"])
    assert {one["fact"]: one["reason"] for one in found["unknown"]}["on(3, 2)"] == "doubtful"
    everything = document(scene)
    assert "supports*(2, 3)" in everything["facts"]
    assert everything["unknown"] == []
