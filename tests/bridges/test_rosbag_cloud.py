"""Clouds out of bags of three kinds, written by rosbags itself, and bags that are none."""

import json
import sys

import numpy as np
import pytest

from lifelore.bridges.rosbag_cloud import read_bag_cloud
from lifelore.core.errors import InputError, MissingExtraError, NotFoundError

TYPE = "sensor_msgs/msg/PointCloud2"
LAYOUT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgb", "<f4"), ("label", "<u2"), ("gap", "V2")])


def message(store, shift, ros1):
    """Six points in two rows, `shift` metres along x."""
    points = np.zeros(6, LAYOUT)
    points["x"], points["z"] = np.arange(6) * 0.1 + shift, 1
    points["rgb"] = np.array([0x0A0B0C], np.uint32).view(np.float32)
    points["label"] = [0, 1, 1, 2, 3, 3]
    field, header = store.types["sensor_msgs/msg/PointField"], store.types["std_msgs/msg/Header"]
    stamp = store.types["builtin_interfaces/msg/Time"](sec=1, nanosec=0)
    codes = {"x": 7, "y": 7, "z": 7, "rgb": 7, "label": 4}
    return store.types[TYPE](
        header=header(stamp=stamp, frame_id="camera", **({"seq": 0} if ros1 else {})),
        height=2,
        width=3,
        fields=[field(name, LAYOUT.fields[name][1], code, 1) for name, code in codes.items()],
        is_bigendian=False,
        point_step=LAYOUT.itemsize,
        row_step=3 * LAYOUT.itemsize,
        data=points.view(np.uint8),
        is_dense=True,
    )


def recorded(folder, kind, topics=("/points",)):
    """A bag of two clouds on each topic, one second apart."""
    from rosbags.rosbag1 import Writer as Writer1
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    ros1 = kind == "bag"
    path = folder / f"seen.{kind}" if ros1 else folder / kind
    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    pack = store.serialize_ros1 if ros1 else store.serialize_cdr
    plugin = {"mcap": StoragePlugin.MCAP, "sqlite3": StoragePlugin.SQLITE3}.get(kind)
    with Writer1(path) if ros1 else Writer(path, version=9, storage_plugin=plugin) as writer:
        for topic in topics:
            connection = writer.add_connection(topic, TYPE, typestore=store)
            for k in range(2):
                writer.write(connection, (k + 1) * 10**9, pack(message(store, k, ros1), TYPE))
    return path


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["bag", "sqlite3", "mcap"])
def test_clouds_come_back_in_order(tmp_path, kind):
    path = recorded(tmp_path, kind)
    for k in range(2):
        cloud = read_bag_cloud(path, "/points" if k else None, k)
        np.testing.assert_allclose(cloud.points[:, 0], np.arange(6) * 0.1 + k, atol=1e-6)
        assert cloud.labels.tolist() == [0, 1, 1, 2, 3, 3]
        assert cloud.colours.tolist() == [[10, 11, 12]] * 6
        assert cloud.grid == (2, 3)
        assert cloud.frame == ("camera", 1.0)


@pytest.mark.slow
def test_a_topic_must_be_named_where_there_are_two_and_exist(tmp_path):
    path = recorded(tmp_path, "mcap", ("/left", "/right"))
    with pytest.raises(NotFoundError, match="/left, /right; name one"):
        read_bag_cloud(path)
    with pytest.raises(NotFoundError, match="no clouds on topic '/up'"):
        read_bag_cloud(path, "/up")
    with pytest.raises(NotFoundError, match="no cloud number 2"):
        read_bag_cloud(path, "/left", 2)
    with pytest.raises(InputError, match="index must be 0 or more"):
        read_bag_cloud(path, "/left", -1)


def test_what_is_no_bag_is_one_line(tmp_path):
    with pytest.raises(InputError, match="no such rosbag"):
        read_bag_cloud(tmp_path / "none.bag")
    (tmp_path / "empty").mkdir()
    path = recorded(tmp_path, "bag")
    damaged = tmp_path / "damaged.bag"
    damaged.write_bytes(path.read_bytes()[:-700])
    for place in (tmp_path / "empty", damaged):
        with pytest.raises(InputError) as caught:
            read_bag_cloud(place)
        assert str(caught.value).startswith(f"{place}: ")
        assert "\n" not in str(caught.value)


def test_a_cloud_that_breaks_a_rule_names_its_bag(tmp_path):
    path = recorded(tmp_path, "mcap")
    with pytest.raises(InputError, match=f"^{path}: units must be"):
        read_bag_cloud(path, units="feet")


def test_without_rosbags_the_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "rosbags.highlevel", None)
    with pytest.raises(MissingExtraError, match="lifelore\\[ros\\]"):
        read_bag_cloud(tmp_path)


@pytest.mark.slow
def test_the_command_line_looks_into_a_bag(tmp_path, capsys):
    from lifelore.app.command_line import run

    path = recorded(tmp_path, "mcap")
    assert run(["perceive", str(path), "--set", "index=1", "--up", "z", "--json"]) == 0
    assert [entry["id"] for entry in json.loads(capsys.readouterr().out)["objects"]] == [2, 3]
    assert run(["perceive", str(path), "--topic", "/nothing"]) == 2
    assert "/points" in capsys.readouterr().err
