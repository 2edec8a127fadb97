"""Logs of a scene are read back: MCAP as a bag of ROS 2, .rrd by Rerun itself; the file's ending decides."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lifelore.bridges.rosbag_cloud import read_bag_cloud
from lifelore.bridges.scene_mcap import DEFINITIONS, SCENE_FRAME
from lifelore.bridges.viewer_log import check_log, write_scene_log
from lifelore.core.cloud_origin import CloudOrigin, SensorFrame
from lifelore.core.errors import InputError, MissingExtraError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.perception.contacts.contact_points import ContactPoint
from lifelore.perception.contacts.interface import Interface
from lifelore.perception.relations.relation import Relation
from lifelore.perception.scene import Scene
from lifelore.perception.scene_json import scene_document

EXAMPLE = Path(__file__).parents[2] / "examples" / "ros2" / "lifelore_msgs" / "msg"
DOWN = np.array([[1.0, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 1], [0, 0, 0, 1]])
"""A camera one metre above the table that looks straight down: its z is the scene's -z."""


@pytest.fixture
def scene():
    """An object (2) on the table with one contact, and one (3) beside it."""
    rng = np.random.default_rng(1)
    points = np.concatenate([rng.uniform(-1, 1, (5, 3)) * [1, 1, 0], rng.uniform(0, 0.1, (40, 3))])
    points[25:] += [0.3, 0, 0]
    labels = np.repeat([1, 2, 3], [5, 20, 20])
    colours = rng.integers(0, 256, (45, 3)).astype(np.uint8)
    up, at = np.array([0, 0, 1.0]), np.array([0.05, 0.05, 0.0])
    above = ContactPoint(at, up, np.zeros(3), 1.0, 7, 1)
    contacts = Interface(2, 1, 0.0, (above,), (replace(above, normal=-up, other=2),), np.array([[0, 0]]))
    origin = CloudOrigin(DOWN, SensorFrame("eye", 12.5))
    relations = (Relation(2, 1, "on", 0.9, 0.0), Relation(2, 3, "adjacent", 0.6, 0.2))
    return Scene(LabelledCloud(points, labels, colours, origin=origin), (contacts,), relations)


def messages(path):
    """{topic: (nanoseconds, message)} of an MCAP file, read by the definitions that the file itself holds."""
    from rosbags.highlevel import AnyReader

    with AnyReader([path]) as reader:
        return {c.topic: (t, reader.deserialize(data, c.msgtype)) for c, t, data in reader.messages()}


def test_an_mcap_file_holds_cloud_boxes_contacts_and_relations(scene, tmp_path):
    pytest.importorskip("rosbags", reason="needs the extra ros")
    path = tmp_path / "scene.mcap"
    path.write_text("an older file")
    document = scene_document(scene)
    write_scene_log(str(path), scene, document)
    assert [file.name for file in tmp_path.iterdir()] == ["scene.mcap"]
    cloud = read_bag_cloud(path)
    assert cloud.frame == ("eye", 12.5)
    np.testing.assert_allclose(cloud.points, scene.cloud.points * [1, -1, -1] + [0, 0, 1], atol=1e-6)
    assert (cloud.labels == scene.cloud.labels).all()
    assert (cloud.colours == scene.cloud.colours).all()
    found = messages(path)
    assert {time for time, _ in found.values()} == {12_500_000_000}
    first, second = found["/lifelore/detections"][1].detections
    assert (first.id, second.id) == ("2", "3")
    centre = first.bbox.center.position
    assert [centre.x, centre.y, centre.z] == pytest.approx(document["objects"][0]["box_camera"]["centre"])
    rows = [(one.a, one.relation, one.b, one.stated) for one in found["/lifelore/relations"][1].relations]
    assert rows == [("2", "on", "table", True), ("2", "adjacent", "3", True)]
    (frame,) = found["/tf_static"][1].transforms
    assert (frame.header.frame_id, frame.child_frame_id) == ("eye", SCENE_FRAME)
    assert frame.transform.translation.z == 1
    assert abs(frame.transform.rotation.x) == 1
    markers = {(one.ns, one.id): one for one in found["/lifelore/markers"][1].markers}
    assert set(markers) == {("boxes", 0), ("boxes", 1), ("contacts", 0), ("contact_edges", 0)}
    for group in ("contacts", "contact_edges"):
        ends = [[at.x, at.y, at.z] for at in markers[group, 0].points]
        assert ends == [pytest.approx([0.05, -0.05, 1])] * 2


def test_the_typed_relations_are_those_of_the_example_package():
    typesys = pytest.importorskip("rosbags.typesys", reason="needs the extra ros")
    for file in EXAMPLE.glob("*.msg"):
        name = f"lifelore_msgs/msg/{file.stem}"
        written = typesys.get_types_from_msg(file.read_text(encoding="utf-8"), name)
        assert written == typesys.get_types_from_msg(DEFINITIONS[name], name)
    assert len(list(EXAMPLE.glob("*.msg"))) == 2


def test_an_rrd_file_holds_the_same(scene, tmp_path):
    chunk = pytest.importorskip("rerun.chunk", reason="needs the extra view")
    path = tmp_path / "scene.rrd"
    write_scene_log(str(path), scene, scene_document(scene))
    found = {}
    for part in chunk.RrdReader(str(path)).stream():
        batch = part.to_record_batch()
        for name in batch.schema.names:
            found[part.entity_path, name] = batch.column(name).to_pylist()
    sizes = {f"{entity}:{name}": len(rows[0] or []) for (entity, name), rows in found.items()}
    assert sizes["/scene/points:Points3D:positions"] == 45
    assert sizes["/scene/contacts:Points3D:positions"] == 2
    assert sizes["/scene/contact_edges:LineStrips3D:strips"] == 1
    assert found["/scene/boxes", "Boxes3D:labels"] == [["2", "3"]]
    half = np.array(found["/scene/boxes", "Boxes3D:half_sizes"][0])
    assert half == pytest.approx(np.array([one["box"]["size"] for one in scene_document(scene)["objects"]]) / 2)
    edges = found["/relations/on", "GraphEdges:edges"][0]
    assert [(edge["first"], edge["second"]) for edge in edges] == [("2", "table")]


def test_another_ending_is_refused(scene):
    with pytest.raises(InputError, match=r"ends with \.mcap or \.rrd, got 'scene\.bag'"):
        check_log("scene.bag")


@pytest.mark.parametrize(
    ("library", "file", "extra"), [("rosbags.rosbag2", "a.mcap", "ros"), ("rerun", "a.rrd", "view")]
)
def test_without_its_library_the_extra_is_named(monkeypatch, library, file, extra):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(MissingExtraError, match=rf"lifelore\[{extra}\]"):
        check_log(file)
