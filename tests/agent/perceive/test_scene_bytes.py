"""A scene as bytes: the layout read back by hand, thinned clouds, grey points, the table's contact points."""

import json
import struct

import numpy as np
import pytest

from lifelore.agent.perceive.scene_bytes import GREY, scene_bytes
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.perception.contacts.contact_points import ContactPoint
from lifelore.perception.contacts.interface import Interface
from lifelore.perception.scene import Scene

POINTS = np.arange(15, dtype=float).reshape(5, 3)
LABELS = np.array([0, 1, 2, 2, 3])


def read(body: bytes):
    (n,) = struct.unpack("<I", body[:4])
    xyz = np.frombuffer(body, "<f4", 3 * n, 4).reshape(n, 3)
    labels = np.frombuffer(body, "<i4", n, 4 + 12 * n)
    colours = np.frombuffer(body, "u1", 3 * n, 4 + 16 * n).reshape(n, 3)
    return xyz, labels, colours, json.loads(body[4 + 19 * n :])


@pytest.mark.parametrize("colours", [None, np.arange(15, dtype=np.uint8).reshape(5, 3)])
def test_the_layout(colours):
    scene = Scene(LabelledCloud(POINTS, LABELS, colours))
    xyz, labels, found, document = read(scene_bytes(scene, {"seconds": 1.5}))
    np.testing.assert_array_equal(xyz, POINTS)
    np.testing.assert_array_equal(labels, LABELS)
    np.testing.assert_array_equal(found, np.full((5, 3), GREY) if colours is None else colours)
    assert document == {"seconds": 1.5, "points": {"shown": 5, "of": 5}, "table_contact_points": []}


def test_a_large_cloud_is_thinned_evenly_from_end_to_end():
    xyz, labels, _, document = read(scene_bytes(Scene(LabelledCloud(POINTS, LABELS)), {}, most=3))
    np.testing.assert_array_equal(xyz, POINTS[[0, 2, 4]])
    np.testing.assert_array_equal(labels, [0, 2, 3])
    assert document["points"] == {"shown": 3, "of": 5}


def test_the_contact_points_of_the_table_are_listed():
    up, spread = np.array([0.0, 0.0, 1.0]), np.zeros(3)
    foot = ContactPoint(np.array([1.0, 2.0, 0.001]), up, spread, 1.0, 4, 1)
    top = ContactPoint(np.array([1.0, 2.0, 0.0]), -up, spread, 1.0, 4, 2)
    pair = Interface(2, 1, 0.001, (foot,), (top,), np.array([[0, 0]]))
    _, _, _, document = read(scene_bytes(Scene(LabelledCloud(POINTS, LABELS), (pair,)), {}))
    assert document["table_contact_points"] == [[1.0, 2.0, 0.0]]
