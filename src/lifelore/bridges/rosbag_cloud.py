"""Reads point clouds from a rosbag (ROS 1, ROS 2 in SQLite or MCAP) without ROS; needs the extra ``ros``."""

from collections.abc import Iterator
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
    clouds = bag_clouds(path, topic, units=units, labels=labels, start=index)
    found = next(clouds, None)
    if found is None:
        raise NotFoundError(f"{path}: holds no cloud number {index}; count from 0")
    return found[1]


def bag_clouds(
    path: str | Path, topic: str | None = None, *, units: str = "m", labels: str = "auto", start: int = 0
) -> Iterator[tuple[float, PointCloud]]:
    """(seconds, cloud) of every message on a topic, in order of time, from number `start` on.

    Raises
    ------
    MissingExtraError, NotFoundError, InputError
        As `read_bag_cloud`.
    """
    path = Path(path)
    with bag_errors(path), opened_bag(path) as reader:
        chosen = topic_of(reader, path, (_TYPE,), "clouds", topic)
        for connection, nanoseconds, content in islice(reader.messages(chosen), start, None):
            message = reader.deserialize(content, connection.msgtype)
            yield nanoseconds * 1e-9, cloud_from_message(message, units=units, labels=labels)
