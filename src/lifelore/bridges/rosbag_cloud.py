"""Reads point clouds from a rosbag (ROS 1, ROS 2 in SQLite or MCAP) without ROS; needs the extra ``ros``."""

from itertools import islice
from pathlib import Path

from lifelore.bridges.rosbag import bag_errors, opened_bag, topic_of
from lifelore.core.errors import InputError, NotFoundError
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.clouds.point_cloud2 import cloud_from_message

_TYPE = "sensor_msgs/msg/PointCloud2"


def read_bag_cloud(
    path: str | Path, topic: str | None = None, index: int = 0, *, units: str = "m", labels: str = "auto"
) -> PointCloud:
    """One cloud of a rosbag.

    Parameters
    ----------
    path : str or Path
        A ROS 1 ``.bag``, a ROS 2 bag's folder, or an ``.mcap`` file.
    topic : str, optional
        Topic of the clouds; not needed if only one topic has clouds.
    index : int
        Number of the topic's message, from 0 in order of time.
    units, labels : str
        As in `read_cloud`.

    Raises
    ------
    MissingExtraError
        rosbags is not installed.
    NotFoundError
        The topic does not exist, or has no cloud number `index`.
    InputError
        The bag is missing or damaged, or the cloud breaks a rule.
    """
    if index < 0:
        raise InputError(f"index must be 0 or more, got {index}")
    path = Path(path)
    with bag_errors(path), opened_bag(path) as reader:
        messages = islice(reader.messages(topic_of(reader, path, (_TYPE,), "clouds", topic)), index, None)
        for connection, _, content in messages:
            message = reader.deserialize(content, connection.msgtype)
            return cloud_from_message(message, units=units, labels=labels)
    raise NotFoundError(f"{path}: holds no cloud number {index}; count from 0")
