"""The JSON document: its keys, finite numbers, names, and that it reads back."""

import json
from dataclasses import replace

import numpy as np

from lifelore.perception.scene_json import scene_document


def document(scene, **options):
    return json.loads(json.dumps(scene_document(scene, **options), allow_nan=False))


def test_every_key_of_the_contract(make_scene, box, meet):
    clouds = {2: box([0, 0, 0], [0.1, 0.05, 0.02]), 30: box([0, 0, 0.02], [0.1, 0.05, 0.04])}
    parts = [meet(2, 30, [[0.01, 0, 0.02], [0.09, 0, 0.02]]), meet(2, 1, [[0.05, 0, 0]])]
    scene = make_scene(clouds, parts, [(30, 2, "on", 0.75), (2, 1, "on", 0.5)])
    found = document(scene, seconds=0.25)
    assert list(found) == ["objects", "relations", "facts", "unknown", "holes", "contact_edges", "seconds"]
    below, above = found["objects"]
    assert [below["id"], above["id"]] == [2, 30]
    assert below["n_points"] == len(clouds[2])
    assert np.allclose(below["centroid"], [0.05, 0.025, 0.01])
    assert [c["other"] for c in below["contact_points"]] == [30, 30, "table"]
    assert below["contact_points"][0]["xyz"] == [0.01, 0, 0.02]
    assert {"xyz", "normal", "extent", "strength"} <= set(below["contact_points"][0])
    assert above["edges"] == [[0, 1]]
    assert {"kind", "xyz", "approach", "closing", "width"} == set(above["grasp_seeds"][0])
    assert found["relations"] == [
        {"a": 30, "b": 2, "relation": "on", "confidence": 0.75, "gap": 0, "stated": True},
        {"a": 2, "b": "table", "relation": "on", "confidence": 0.5, "gap": 0, "stated": True},
    ]
    assert {"on(30, 2)", "on(2, table)", "clear(30)", "supports*(2, 30)", "ec(table, 2)"} <= set(found["facts"])
    assert len(found["facts"]) == len(set(found["facts"]))
    assert found["holes"] == []
    assert found["seconds"] == 0.25


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
    assert document(make_scene({})) == {
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
