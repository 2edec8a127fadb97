"""Transforms in the plane from ``/tf`` and ``/tf_static`` of a rosbag, looked up at points of time."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

HOLD = 1.0
"""Seconds before the first and after the last transform of a pair of frames for which that transform counts."""


def planar(position: Any, q: Any) -> tuple[float, float, float]:
    """x, y (metres) and yaw (radians) of a ROS position and quaternion; tilt is ignored."""
    return position.x, position.y, np.arctan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))


def composed(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """The poses (n, 3) of c in frame a, from those of b in a and of c in b; x, y and yaw."""
    cos, sin = np.cos(a[:, 2]), np.sin(a[:, 2])
    x, y = b[:, 0], b[:, 1]
    return np.column_stack([a[:, 0] + cos * x - sin * y, a[:, 1] + sin * x + cos * y, a[:, 2] + b[:, 2]])


def frame_name(name: str) -> str:
    """The name of a frame without the leading slash of ROS 1."""
    return name.lstrip("/")


class FrameTree:
    """Poses of frames in their parents over time."""

    def __init__(self) -> None:
        self._parent: dict[str, str] = {}
        self._moving: dict[str, list[tuple[float, float, float, float]]] = {}
        self._fixed: dict[str, tuple[float, float, float]] = {}

    def add(self, transforms: Iterable[Any], fixed: bool) -> None:
        """Add the transforms of a ``tf2_msgs/TFMessage``; fixed ones come from ``/tf_static``."""
        for one in transforms:
            child = frame_name(one.child_frame_id)
            pose = planar(one.transform.translation, one.transform.rotation)
            self._parent[child] = frame_name(one.header.frame_id)
            if fixed:
                self._fixed[child] = pose
            else:
                self._moving.setdefault(child, []).append((seconds(one.header.stamp), *pose))

    def chain(self, child: str, ancestor: str) -> list[str] | None:
        """The frames from `child` up to, without, `ancestor`; None if no transforms join the two."""
        chain = []
        while child != ancestor:
            if child in chain or child not in self._parent:
                return None
            chain.append(child)
            child = self._parent[child]
        return chain

    def stamps(self, chain: list[str]) -> NDArray[np.float64]:
        """(n,) seconds of the transforms of that frame of a chain that moves most often; none if all are fixed."""
        most = max((self._moving.get(child, []) for child in chain), key=len, default=[])
        return np.unique([row[0] for row in most])

    def poses(self, chain: list[str], stamps: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 3) pose of the first frame of a chain in the ancestor; NaN where a transform is not known."""
        poses = np.zeros((len(stamps), 3))
        for child in chain:
            poses = composed(self._at(child, stamps), poses)
        return poses

    def _at(self, child: str, stamps: NDArray[np.float64]) -> NDArray[np.float64]:
        if child not in self._moving:
            return np.tile(self._fixed[child], (len(stamps), 1))
        rows = np.array(sorted(self._moving[child]))
        rows[:, 3] = np.unwrap(rows[:, 3])
        poses = np.column_stack([np.interp(stamps, rows[:, 0], column) for column in rows[:, 1:].T])
        poses[(stamps < rows[0, 0] - HOLD) | (stamps > rows[-1, 0] + HOLD)] = np.nan
        return poses


def seconds(stamp: Any) -> float:
    """Seconds of a ROS time."""
    return stamp.sec + stamp.nanosec * 1e-9
