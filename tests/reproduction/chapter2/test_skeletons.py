"""Readings of a skeleton, rows of results and paths, on scenes made by hand."""

import json

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import NONE, ON
from lifelore.perception.relations.relation import Relation
from lifelore.perception.scene import Scene
from reproduction.chapter2.c2_07_oversegmented_stack.run import Three, is_path
from reproduction.chapter2.scenes.scene_example import scene_of_row, scene_row
from reproduction.chapter2.scenes.skeletons import reading
from tests.perception.conftest import interface


def tower():
    """2 below 3 below 4, on the table, and 2 near 4."""
    points = np.array([[x, y, z] for z in (0.0, 0.05, 0.15, 0.25) for x in (0, 0.05) for y in (0, 0.05)], float)
    cloud = LabelledCloud(points, np.repeat([TABLE, 2, 3, 4], 4), None, np.array([0.0, -1.0, 0.5]))
    met = ((2, 3, (0, 0, 0.1)), (3, 4, (0, 0, 0.2)), (2, 4, (0.05, 0, 0.15)), (2, TABLE, (0, 0, 0)))
    said = ((3, 2, ON), (4, 3, ON), (2, 4, NONE), (2, TABLE, ON))
    return Scene(
        cloud,
        tuple(interface(a, b, [at]) for a, b, at in met),
        tuple(Relation(a, b, word, 1.0, 0.0) for a, b, word in said),
    )


def points_of(scene):
    return {label: len(network.nodes) for label, network in scene.networks.items()}


def test_readings_by_hand():
    scene = tower()
    assert points_of(reading(scene)) == {2: 1, 3: 2, 4: 1}
    assert points_of(reading(scene, ground=True)) == {TABLE: 1, 2: 2, 3: 2, 4: 1}


def test_a_tower_is_a_path_through_its_middle_alone():
    scene = reading(tower())
    assert is_path(scene, Three(scene.cloud, 2, 3, 4))
    assert not is_path(scene, Three(scene.cloud, 3, 2, 4))
    assert not is_path(tower(), Three(scene.cloud, 2, 3, 4))


def test_a_row_comes_back_as_the_scene_it_was():
    scene = tower()
    row = json.loads(json.dumps(scene_row(scene, "a tower")))
    cloud, document, caption = scene_of_row(row)
    assert caption == "a tower"
    assert sorted(map(tuple, cloud.points.round(4))) == sorted(map(tuple, scene.cloud.points))
    assert cloud.labels.tolist() == sorted(scene.cloud.labels.tolist())
    assert cloud.camera == pytest.approx([0, -1, 0.5])
    assert [len(thing["contact_points"]) for thing in document["objects"]] == [3, 2, 2]
    assert len(document["relations"]) == 4


def test_large_clouds_are_thinned():
    rng = np.random.default_rng(0)
    cloud = LabelledCloud(rng.uniform(0, 0.3, (40_000, 3)), np.full(40_000, 2))
    assert len(json.dumps(scene_row(Scene(cloud), ""))) < 60_000
