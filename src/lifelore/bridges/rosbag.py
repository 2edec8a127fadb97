"""Opens rosbags (ROS 1, ROS 2 in SQLite or MCAP) without ROS; needs the extra ``ros``."""

import os
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from lifelore.core.errors import InputError, LifeloreError, MissingExtraError, NotFoundError

if TYPE_CHECKING:
    from rosbags.highlevel import AnyReader
    from rosbags.interfaces import Connection


def is_bag(path: str) -> bool:
    """Whether a path names a rosbag, by its ending or by the file that describes a ROS 2 bag."""
    return path.endswith((".bag", ".mcap", ".db3")) or os.path.isfile(os.path.join(path, "metadata.yaml"))


def opened_bag(path: Path) -> "AnyReader":
    """A reader, to be used in a ``with`` block.

    Raises
    ------
    MissingExtraError
        rosbags is not installed.
    InputError
        There is no such bag.
    """
    try:
        from rosbags.highlevel import AnyReader
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        raise MissingExtraError("rosbags are read with the extra ros: pip install 'lifelore[ros]'") from None
    if not path.exists():
        raise InputError(f"{path}: no such rosbag")
    return AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE))


def topic_of(
    reader: "AnyReader", path: Path, types: Collection[str], content: str, topic: str | None
) -> "list[Connection]":
    """The connections of a topic with messages of these types; the only such topic if none is named.

    Raises
    ------
    NotFoundError
        There is no such topic, or several and none is named; the message calls the messages `content`.
    """
    fitting = [connection for connection in reader.connections if connection.msgtype in types]
    topics = sorted({connection.topic for connection in fitting})
    if topic is not None and topic not in topics:
        raise NotFoundError(
            f"{path}: no {content} on topic {topic!r}; there are {content} on {', '.join(topics) or 'none'}"
        )
    if topic is None and len(topics) != 1:
        raise NotFoundError(f"{path}: {content} on {', '.join(topics) or 'no topic'}; name one topic")
    return [connection for connection in fitting if connection.topic == (topic or topics[0])]


@contextmanager
def bag_errors(path: Path) -> Iterator[None]:
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
