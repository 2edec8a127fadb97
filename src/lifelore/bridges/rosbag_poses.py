"""Poses of a robot from a rosbag: nav_msgs/Odometry, geometry_msgs/PoseStamped or PoseWithCovarianceStamped."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.bridges.rosbag import bag_errors, opened_bag, topic_of
from lifelore.core.errors import InputError

_TYPES = (
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "nav_msgs/msg/Odometry",
)


class BagPoses(NamedTuple):
    """Poses in order of time.

    time : (n,) seconds
    points : (n, 2) x and y in metres of the frame in which they were recorded
    heading : (n,) radians about the vertical axis, 0 along x
    """

    time: NDArray[np.float64]
    points: NDArray[np.float64]
    heading: NDArray[np.float64]


def read_bag_poses(path: str | Path, topic: str | None = None) -> BagPoses:
    """The poses on a topic; the topic need not be named if only one has poses.

    Raises
    ------
    MissingExtraError
        rosbags is not installed.
    NotFoundError
        The topic does not exist, or several topics have poses and none is named.
    InputError
        The bag is missing, damaged or without a pose, or a pose is not finite.
    """
    path = Path(path)
    rows = []
    with bag_errors(path), opened_bag(path) as reader:
        for connection, nanoseconds, content in reader.messages(topic_of(reader, path, _TYPES, "poses", topic)):
            pose: Any = reader.deserialize(content, connection.msgtype).pose  # type: ignore[attr-defined]
            pose = getattr(pose, "pose", pose)  # with a covariance, the pose lies one level deeper
            q = pose.orientation
            heading = np.arctan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))
            rows.append((nanoseconds * 1e-9, pose.position.x, pose.position.y, heading))
        if not rows:
            raise InputError("holds no pose")
        columns = np.array(rows)
        if not np.isfinite(columns).all():
            raise InputError("a pose has a coordinate that is no finite number")
    return BagPoses(columns[:, 0], columns[:, 1:3], columns[:, 3])
