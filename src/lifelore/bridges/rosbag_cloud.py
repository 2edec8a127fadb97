"""Reads point clouds from a rosbag (ROS 1, ROS 2 in SQLite or MCAP) without ROS; needs the extra ``ros``."""

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from lifelore.core.errors import InputError, LifeloreError, MissingExtraError, NotFoundError
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.clouds.point_cloud2 import cloud_from_message

if TYPE_CHECKING:
    from rosbags.highlevel import AnyReader

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
    with _input_errors(path), _opened(path) as reader:
        with_clouds = [connection for connection in reader.connections if connection.msgtype == _TYPE]
        topics = sorted({connection.topic for connection in with_clouds})
        name = _topic(path, topics, topic)
        chosen = [connection for connection in with_clouds if connection.topic == name]
        for connection, nanoseconds, content in islice(reader.messages(chosen), start, None):
            message = reader.deserialize(content, connection.msgtype)
            yield nanoseconds * 1e-9, cloud_from_message(message, units=units, labels=labels)


def _topic(path: Path, topics: list[str], topic: str | None) -> str:
    if topic is not None and topic not in topics:
        raise NotFoundError(
            f"{path}: no clouds on topic {topic!r}; there are clouds on {', '.join(topics) or 'none'}"
        )
    if topic is None and len(topics) != 1:
        raise NotFoundError(f"{path}: clouds on {', '.join(topics) or 'no topic'}; name one topic")
    return topic or topics[0]


def _opened(path: Path) -> "AnyReader":
    try:
        from rosbags.highlevel import AnyReader
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        raise MissingExtraError("rosbags are read with the extra ros: pip install 'lifelore[ros]'") from None
    if not path.exists():
        raise InputError(f"{path}: no such rosbag")
    return AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE))


@contextmanager
def _input_errors(path: Path) -> Iterator[None]:
    """Turn every error of a damaged bag into an InputError that names the file."""
    try:
        yield
    except InputError as error:
        raise InputError(str(error) if str(error).startswith(str(path)) else f"{path}: {error}") from None
    except LifeloreError:
        raise
    except Exception as error:  # a damaged bag can fail anywhere in its decoder
        reason = " ".join(str(error).split())[:200]
        raise InputError(
            f"{path}: is damaged or no rosbag ({type(error).__name__}: {reason}); record it again"
        ) from error
