"""Clouds from `sensor_msgs/PointCloud2` messages of rclpy, rospy or rosbags, none of which is imported."""

from dataclasses import replace
from typing import Any

import numpy as np

from lifelore.core.cloud_origin import NO_FRAME, SensorFrame
from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_columns import MAX_POINTS, cloud_from_columns, readable_fields
from lifelore.perception.clouds.cloud_scale import in_metres
from lifelore.perception.clouds.point_cloud import PointCloud

_CODES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}


def cloud_from_message(message: Any, *, units: str = "m", labels: str = "auto") -> PointCloud:
    """The cloud in a PointCloud2 message; the camera stands at the origin of the message's frame.

    Parameters
    ----------
    message : object
        With ``height, width, fields (name, offset, datatype, count), is_bigendian, point_step, row_step, data``
        and, where it names its frame, ``header``.
    units, labels : str
        As in `read_cloud`.

    Raises
    ------
    InputError
        Sizes contradict each other, coordinates are missing, or the cloud is empty.
    """
    height, width, step = int(message.height), int(message.width), int(message.point_step)
    row = int(message.row_step) or width * step
    data = np.frombuffer(bytes(message.data), np.uint8)
    if min(height, width, step) < 1 or height * width > MAX_POINTS:
        raise InputError(f"PointCloud2 must hold 1 to {MAX_POINTS} points, got {height} × {width} of {step} bytes")
    if row < width * step or (height - 1) * row + width * step > len(data):
        raise InputError(
            f"PointCloud2 promises {height} rows of {row} bytes, {width} points of {step} each, got {len(data)}"
        )
    rows = np.lib.stride_tricks.as_strided(data, (height, width * step), (row, 1), writeable=False)
    records = np.ascontiguousarray(rows).reshape(-1).view(_layout(message, step))
    columns = {name: records[name] for name in records.dtype.names or ()}
    cloud = in_metres(cloud_from_columns(columns, labels, (height, width), np.zeros(3)), units)
    return replace(cloud, frame=_frame(message))


def _frame(message: Any) -> SensorFrame:
    """Of the header; ROS 1 calls the parts of a time by other names than ROS 2."""
    header = getattr(message, "header", None)
    if header is None:
        return NO_FRAME
    stamp = header.stamp
    seconds, nanoseconds = (stamp.sec, stamp.nanosec) if hasattr(stamp, "sec") else (stamp.secs, stamp.nsecs)
    return SensorFrame(str(header.frame_id) or None, float(seconds) + float(nanoseconds) * 1e-9)


def _layout(message: Any, step: int) -> np.dtype:
    fields = {str(field.name): (int(field.datatype), int(field.offset)) for field in message.fields}
    names = readable_fields(list(fields))
    order = ">" if message.is_bigendian else "<"
    for name in names:
        code, offset = fields[name]
        if code not in _CODES or offset < 0 or offset + np.dtype(_CODES[code]).itemsize > step:
            raise InputError(
                f"PointCloud2 field {name!r} (datatype {code}, offset {offset}) does not fit {step} bytes"
            )
    return np.dtype(
        {
            "names": names,
            "formats": [order + _CODES[fields[name][0]] for name in names],
            "offsets": [fields[name][1] for name in names],
            "itemsize": step,
        }
    )
