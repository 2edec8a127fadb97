"""Writes a ROS 2 bag of a robot that drives: transforms, poses, goals and bumps, with a recorder that lags."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

LAG = 0.05
"""Seconds from a stamp until the recorder gets the message."""
SUCCEEDED, CANCELED, ABORTED, EXECUTING = 4, 5, 6, 2


@dataclass
class RobotBag:
    """Messages by time of receipt; `write` writes them."""

    path: Path
    rows: list[tuple[float, str, str, Any]] = field(default_factory=list)

    def __post_init__(self) -> None:
        from rosbags.typesys import Stores, get_typestore

        self.store = get_typestore(Stores.ROS2_HUMBLE)
        self.make = self.store.types

    def transform(self, time: float, parent: str, child: str, pose, fixed: bool = False) -> None:
        """A pose (x, y, yaw) of a frame in its parent."""
        at = self.make["geometry_msgs/msg/Vector3"](x=float(pose[0]), y=float(pose[1]), z=0.1)
        transform = self.make["geometry_msgs/msg/Transform"](at, self._turn(pose[2]))
        stamped = self.make["geometry_msgs/msg/TransformStamped"](self._header(time, parent), child, transform)
        message = self.make["tf2_msgs/msg/TFMessage"]([stamped])
        self._add(time, "/tf_static" if fixed else "/tf", "tf2_msgs/msg/TFMessage", message)

    def pose(self, time: float, topic: str, frame: str, pose, kind: str = "geometry_msgs/msg/PoseStamped") -> None:
        """A pose (x, y, yaw) on a topic."""
        at = self.make["geometry_msgs/msg/Point"](x=float(pose[0]), y=float(pose[1]), z=0.0)
        body = self.make["geometry_msgs/msg/Pose"](at, self._turn(pose[2]))
        if kind != "geometry_msgs/msg/PoseStamped":
            body = self.make["geometry_msgs/msg/PoseWithCovariance"](body, np.zeros(36))
        parts = [self._header(time, frame), body]
        if kind == "nav_msgs/msg/Odometry":
            zero = self.make["geometry_msgs/msg/Vector3"](0.0, 0.0, 0.0)
            twist = self.make["geometry_msgs/msg/Twist"](zero, zero)
            parts[1:1] = ["base_link"]
            parts.append(self.make["geometry_msgs/msg/TwistWithCovariance"](twist, np.zeros(36)))
        self._add(time, topic, kind, self.make[kind](*parts))

    def goals(self, time: float, status: dict[int, int], topic: str = "/navigate_to_pose/_action/status") -> None:
        """The status of goals by number."""
        entries = []
        for number, value in status.items():
            uuid = self.make["unique_identifier_msgs/msg/UUID"](np.full(16, number, np.uint8))
            info = self.make["action_msgs/msg/GoalInfo"](uuid, self._stamp(0.0))
            entries.append(self.make["action_msgs/msg/GoalStatus"](info, value))
        kind = "action_msgs/msg/GoalStatusArray"
        self._add(time, topic, kind, self.make[kind](entries))

    def pressed(self, time: float, value: bool, topic: str = "/bumper") -> None:
        """A bumper."""
        self._add(time, topic, "std_msgs/msg/Bool", self.make["std_msgs/msg/Bool"](value))

    def write(self) -> Path:
        """Write the bag as MCAP."""
        from rosbags.rosbag2 import StoragePlugin, Writer

        with Writer(self.path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
            topics = {}
            for time, topic, kind, message in sorted(self.rows, key=lambda row: row[0]):
                if topic not in topics:
                    topics[topic] = writer.add_connection(topic, kind, typestore=self.store)
                writer.write(topics[topic], round((time + LAG) * 1e9), self.store.serialize_cdr(message, kind))
        return self.path

    def _add(self, time: float, topic: str, kind: str, message: Any) -> None:
        self.rows.append((time, topic, kind, message))

    def _header(self, time: float, frame: str):
        return self.make["std_msgs/msg/Header"](stamp=self._stamp(time), frame_id=frame)

    def _stamp(self, time: float):
        return self.make["builtin_interfaces/msg/Time"](sec=int(time), nanosec=round(time % 1 * 1e9) % 10**9)

    def _turn(self, yaw: float):
        return self.make["geometry_msgs/msg/Quaternion"](0.0, 0.0, float(np.sin(yaw / 2)), float(np.cos(yaw / 2)))


def drive(bag: RobotBag, times: Iterable[float], map_odom, odom_base, every: int = 5) -> None:
    """Transforms of a localised robot: odom → base_footprint at all `times`, map → odom at each fifth.

    map_odom, odom_base : functions of time that return x, y, yaw
    """
    bag.transform(0.0, "base_footprint", "base_link", (0.0, 0.0, 0.0), fixed=True)
    for number, time in enumerate(times):
        bag.transform(time, "odom", "base_footprint", odom_base(time))
        if number % every == 0:
            bag.transform(time, "map", "odom", map_odom(time))
