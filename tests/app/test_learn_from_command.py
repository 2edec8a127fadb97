"""`lifelore learn-from` on a CSV log and on a rosbag, and its refusals."""

from pathlib import Path

import numpy as np
import pytest

from lifelore.domains.worlds import make_world

from ..agent.learn_from.robot_runs import csv_text, driven_run

MAP = Path(__file__).parents[2] / "examples" / "data" / "office.yaml"


@pytest.fixture(scope="module")
def world():
    return make_world("building", map=MAP)


def test_a_log_is_learnt_once(ask, world, tmp_path):
    Path("runs.csv").write_text(csv_text([driven_run(world, number) for number in range(3)]))
    arguments = ("learn-from", "runs.csv", "--map", MAP, "--memory", "m.db")
    said = ask(*arguments)
    assert (said.status, said.err) == (0, "")
    assert "a new building: office" in said.out
    assert "3 of 3 runs are new; 3 reached their goal" in said.out
    again = ask(*arguments, "--json").document
    assert (again["new"], again["runs"], again["building"]["recognised"]) == (0, 3, True)


def bag_of(run, path: Path, kind: str) -> Path:
    """A ROS 2 bag of a run's poses."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    make = store.types
    stamp = make["builtin_interfaces/msg/Time"](sec=0, nanosec=0)
    header = make["std_msgs/msg/Header"](stamp=stamp, frame_id="map")
    with Writer(path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/amcl_pose", kind, typestore=store)
        for time, (x, y) in zip(run.time, run.points, strict=True):
            at = make["geometry_msgs/msg/Point"](x=x, y=y, z=0.0)
            pose = make["geometry_msgs/msg/Pose"](at, make["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.6, 0.8))
            if "Covariance" in kind:
                pose = make["geometry_msgs/msg/PoseWithCovariance"](pose, np.zeros(36))
            message = make[kind](header, pose)
            writer.write(connection, int(time * 1e9) + 1, store.serialize_cdr(message, kind))
    return path


@pytest.mark.parametrize("kind", ["PoseStamped", "PoseWithCovarianceStamped"])
def test_a_rosbag_of_poses_is_one_run(kind, ask, world, tmp_path):
    pytest.importorskip("rosbags")
    bag = bag_of(driven_run(world, 1), tmp_path / "bag", f"geometry_msgs/msg/{kind}")
    arguments = ("learn-from", bag, "--map", MAP, "--memory", tmp_path / "m.db", "--json")
    report = ask(*arguments, "--reached-goal").document
    assert (report["runs"], report["new"], report["to_goal"], report["outside"]) == (1, 1, 1, 0)
    assert report["moves"] > 5
    assert "no poses on topic '/odom'" in ask(*arguments, "--topic", "/odom").err


def test_refusals(ask, tmp_path):
    Path("runs.csv").write_text("time,x,y\n0,0,0\n")
    for arguments, words in (
        (("runs.csv",), "Missing option '--map'"),
        (("none.csv", "--map", MAP), "does not exist"),
        (("runs.csv", "--map", MAP, "--topic", "/a"), "topic applies to rosbags"),
        (("runs.csv", "--map", "none.yaml"), "no such file"),
        (("none.bag", "--map", MAP), "no such rosbag"),
    ):
        said = ask("learn-from", *arguments)
        assert said.status == 2
        assert words in said.err
        assert len(said.err.splitlines()) == 1
