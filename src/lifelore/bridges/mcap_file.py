"""Writes messages of ROS 2 to an MCAP file, without ROS; needs the extra ``ros``."""

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from lifelore.core.errors import InputError, MissingExtraError

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

Write = Callable[[str, str, Mapping[str, Any], int], None]
"""Takes a topic, the type of a message, its fields, and a time in nanoseconds."""


def check_ros_extra() -> None:
    """Raise MissingExtraError where rosbags is not installed."""
    try:
        import rosbags.rosbag2  # noqa: F401
    except ImportError:
        raise MissingExtraError("a log in MCAP needs the extra ros: pip install 'lifelore[ros]'") from None


@contextmanager
def mcap_writer(path: Path, definitions: Mapping[str, str]) -> Iterator[Write]:
    """A function that writes messages of ROS 2 Humble to an MCAP file; used in a ``with`` block.

    A topic has one type, and its messages are written in order of time.

    Parameters
    ----------
    path : Path
        Written when the block ends without an error; a file of this name is replaced.
    definitions : mapping of str to str
        Texts of further message types by their names, such as ``vision_msgs/msg/Detection3D``.

    Raises
    ------
    MissingExtraError
        rosbags is not installed.
    """
    check_ros_extra()
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    for name, text in definitions.items():
        store.register(get_types_from_msg(text, name))
    with TemporaryDirectory(dir=path.parent) as folder:
        with Writer(Path(folder) / "log", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
            topics: dict[str, Any] = {}

            def write(topic: str, kind: str, fields: Mapping[str, Any], nanoseconds: int) -> None:
                if topic not in topics:
                    topics[topic] = writer.add_connection(topic, kind, typestore=store)
                data = store.serialize_cdr(message_of(store, kind, fields), kind)
                writer.write(topics[topic], nanoseconds, data)

            yield write
        (written,) = Path(folder).glob("log/*.mcap")
        os.replace(written, path)


def message_of(store: "Typestore", name: str, fields: Mapping[str, Any]) -> Any:
    """A message with these fields, zero and empty elsewhere; messages within it are mappings too.

    Raises
    ------
    InputError
        The message has no such field.
    """
    kinds = dict(store.fielddefs[name][1])
    if unknown := set(fields) - set(kinds):
        raise InputError(f"{name} has no field {', '.join(sorted(unknown))}; its fields are {', '.join(kinds)}")
    return store.types[name](**{field: _value(store, kind, fields.get(field)) for field, kind in kinds.items()})


def _value(store: "Typestore", kind: Any, given: Any) -> Any:
    """`kind` is rosbags' description of a field: (a base type, a message, or an array or sequence of these)."""
    node, detail = kind
    if node.name == "NAME":
        return message_of(store, detail, given or {})
    if node.name == "BASE":
        base = detail[0]
        return given if given is not None else "" if base == "string" else np.dtype(base).type(0).item()
    (inner, of), length = detail
    if inner.name == "NAME":
        return [message_of(store, of, one) for one in given or []]
    if of[0] == "string":
        return list(given or [])
    return np.zeros(length, of[0]) if given is None else np.asarray(given, of[0])
