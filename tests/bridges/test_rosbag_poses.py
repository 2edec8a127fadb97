"""The log of a robot in a bag: chains of transforms worked by hand, frames refused, runs cut by goals, bumps."""

import numpy as np
import pytest

pytest.importorskip("rosbags")

from lifelore.bridges.mcap_file import message_of
from lifelore.bridges.rosbag_poses import read_bag_log
from lifelore.core.errors import InputError, NotFoundError

from .robot_bag import ABORTED, EXECUTING, SUCCEEDED, RobotBag, drive

START = 1_700_000_000.0
TIMES = START + np.arange(0, 20, 0.1)


def map_odom(time: float):
    """The odometry's origin lies at (3, 4) of the map, turned by a quarter, and drifts along x."""
    return 3.0 + 0.01 * (time - START), 4.0, np.pi / 2


def odom_base(time: float):
    return 0.5 * (time - START), 1.0, 0.2


def true_pose(time):
    """Worked by hand: R(90°) · (0.5 t, 1) + (3 + 0.01 t, 4) = (2 + 0.01 t, 4 + 0.5 t), heading 90° + 0.2."""
    t = time - START
    return np.column_stack([2.0 + 0.01 * t, 4.0 + 0.5 * t])


@pytest.fixture
def bag(tmp_path):
    return RobotBag(tmp_path / "bag")


def test_poses_come_from_the_chain_of_transforms(bag):
    drive(bag, TIMES, map_odom, odom_base)
    bag.pose(START + 3, "/amcl_pose", "map", (0.0, 0.0, 0.0))
    log = read_bag_log(bag.write())
    assert np.allclose(log.time, TIMES, atol=1e-6)
    assert np.allclose(log.points, true_pose(log.time), atol=0.006)  # the last map → odom is half a second old
    assert np.allclose(log.heading, np.pi / 2 + 0.2)
    assert set(log.outcome) == {""}
    assert not log.ends.any()


def test_odometry_is_transformed_at_its_own_stamps(bag):
    drive(bag, TIMES[::10], map_odom, odom_base, every=1)
    for time in TIMES[::3]:
        bag.pose(time, "/odom", "odom", odom_base(time), "nav_msgs/msg/Odometry")
    log = read_bag_log(bag.write(), topic="/odom")
    assert np.allclose(log.time, TIMES[::3], atol=1e-6)
    assert np.allclose(log.points, true_pose(log.time), atol=0.01)


def test_poses_in_the_map_need_no_transforms(bag):
    for time in TIMES[::5]:
        bag.pose(
            time, "/amcl_pose", "map", (*true_pose(time)[0], 0.3), "geometry_msgs/msg/PoseWithCovarianceStamped"
        )
    log = read_bag_log(bag.write())
    assert np.allclose(log.points, true_pose(TIMES[::5]))
    assert np.allclose(log.heading, 0.3)


def test_a_bag_of_ros_1_is_read_too(tmp_path):
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store, kind = get_typestore(Stores.ROS1_NOETIC), "tf2_msgs/msg/TFMessage"
    store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", kind))
    with Writer(tmp_path / "one.bag") as writer:
        connection = writer.add_connection("/tf", kind, typestore=store)
        for k in range(3):
            header = {"frame_id": "/map", "stamp": {"sec": 100 + k, "nanosec": 500_000_000}}
            pose = {"translation": {"x": 2.0 * k, "y": 3.0}, "rotation": {"w": 1.0}}
            one = {"header": header, "child_frame_id": "/base_link", "transform": pose}
            message = message_of(store, kind, {"transforms": [one]})
            writer.write(connection, (100 + k) * 10**9, store.serialize_ros1(message, kind))
    log = read_bag_log(tmp_path / "one.bag")
    assert log.time.tolist() == [100.5, 101.5, 102.5]
    assert log.points.tolist() == [[0, 3], [2, 3], [4, 3]]


@pytest.mark.parametrize("frame", ["odom", "", "world"])
def test_a_frame_that_no_transform_joins_to_the_map_is_refused(bag, frame):
    bag.transform(START, "odom", "base_link", (0.0, 0.0, 0.0))
    bag.pose(START, "/odom", frame, (0.0, 0.0, 0.0), "nav_msgs/msg/Odometry")
    message = f"poses on /odom are in the frame '{frame}', and the bag has no transform from 'map' to '{frame}'"
    with pytest.raises(InputError, match=message) as caught:
        read_bag_log(bag.write())
    assert "\n" not in str(caught.value)
    with pytest.raises(InputError, match="joins base_link and base_footprint with no frame 'map'"):
        read_bag_log(bag.path, topic="/tf")


def test_poses_without_a_transform_at_their_time_are_left_out(bag):
    drive(bag, TIMES, map_odom, odom_base)
    for time in START + np.array([-30.0, 5.0, 10.0, 90.0]):
        bag.pose(time, "/odom", "odom", odom_base(time), "nav_msgs/msg/Odometry")
    assert np.allclose(read_bag_log(bag.write(), topic="/odom").time, START + np.array([5.0, 10.0]))


def test_goals_cut_the_log_into_runs_with_outcomes(bag):
    drive(bag, TIMES, map_odom, odom_base)
    bag.goals(START - 5, {9: SUCCEEDED})  # ended before the bag
    bag.goals(START + 2, {9: SUCCEEDED, 1: EXECUTING})
    bag.goals(START + 6, {1: SUCCEEDED})
    bag.goals(START + 8, {1: SUCCEEDED, 2: EXECUTING})
    bag.goals(START + 10, {2: EXECUTING, 3: EXECUTING})  # preempted: the old goal ends after the new one begins
    bag.goals(START + 10.5, {2: ABORTED, 3: EXECUTING})
    bag.goals(START + 15, {3: SUCCEEDED})
    log = read_bag_log(bag.write())
    ends = np.flatnonzero(log.ends)
    assert np.allclose(log.time[ends] - START, [2, 6, 8, 10.5, 15], atol=0.11)
    assert [log.outcome[i] for i in ends] == ["", "goal", "", "failed", "goal"]


def test_bumps_count_once_while_pressed(bag):
    drive(bag, TIMES, map_odom, odom_base)
    for time, value in ((1.0, False), (4.0, True), (4.2, True), (5.0, False), (7.0, True)):
        bag.pressed(START + time, value)
        bag.pressed(START + time + 1, value, "/left/contact")
    log = read_bag_log(bag.write())
    assert np.allclose(log.time[[word == "bump" for word in log.outcome]] - START, [4, 7], atol=0.06)
    other = read_bag_log(bag.path, bumps="/left/contact")
    assert np.allclose(other.time[[word == "bump" for word in other.outcome]] - START, [5, 8], atol=0.06)


def test_a_topic_that_holds_no_bumps_is_refused(bag):
    drive(bag, TIMES[:3], map_odom, odom_base)
    path = bag.write()
    with pytest.raises(NotFoundError, match="no topic '/bumps' for bumps"):
        read_bag_log(path, bumps="/bumps")
    with pytest.raises(InputError, match=r"bumps must have a type of std_msgs/msg/Bool, .* got tf2_msgs"):
        read_bag_log(path, bumps="/tf")
