"""Outcomes of runs in a rosbag: goals of nav2's action servers, and bumps."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from lifelore.core.errors import InputError, NotFoundError

if TYPE_CHECKING:
    from lifelore.bridges.rosbag import AnyReader, Connection

GOAL_TOPIC = "/navigate_to_pose/_action/status"
"""End of the topics whose goals cut the log into runs."""
BUMP_TOPICS = ("/bump", "/bumper")
"""Topics of `BUMP_TYPES` that are read where none is named."""
BUMP_TYPES = {
    "std_msgs/msg/Bool": lambda message: message.data,
    "kobuki_ros_interfaces/msg/BumperEvent": lambda message: message.state == 1,
    "irobot_create_msgs/msg/HazardDetectionVector": lambda message: any(
        one.type == 1 for one in message.detections
    ),
}
"""Type of a message: whether the robot touches an obstacle."""
_GOAL_TYPE = "action_msgs/msg/GoalStatusArray"
_ENDS = {4: "goal", 5: "failed", 6: "failed"}
"""Status of a goal (``action_msgs/GoalStatus``: succeeded, canceled, aborted): outcome of the run."""


class Goals:
    """Begins and ends of goals, from ``action_msgs/GoalStatusArray`` messages in order of time."""

    def __init__(self) -> None:
        self._running: set[bytes] = set()
        self._ended: set[bytes] = set()
        self.events: list[tuple[float, str]] = []
        """(seconds, outcome) of each end; the outcome is empty where a goal begins after a time without one."""

    def add(self, time: float, message: Any) -> None:
        """Take in one message. A goal that had ended before its first message lies before the bag."""
        for one in message.status_list:
            name = bytes(bytearray(one.goal_info.goal_id.uuid))
            ended = _ENDS.get(one.status)
            if ended is None and name not in self._running | self._ended:
                if not self._running:
                    self.events.append((time, ""))
                self._running.add(name)
            elif ended is not None and name in self._running:
                self.events.append((time, ended))
                self._running.remove(name)
                self._ended.add(name)


class Bumps:
    """Times at which a bumper was pressed."""

    def __init__(self) -> None:
        self._pressed = False
        self.times: list[float] = []

    def add(self, time: float, msgtype: str, message: Any) -> None:
        """Take in one message; a bumper that stays pressed counts once."""
        pressed = bool(BUMP_TYPES[msgtype](message))
        if pressed and not self._pressed:
            self.times.append(time)
        self._pressed = pressed


def goal_connections(reader: "AnyReader") -> "list[Connection]":
    """Connections of the topics that tell how nav2's goals went."""
    return [one for one in reader.connections if one.topic.endswith(GOAL_TOPIC) and one.msgtype == _GOAL_TYPE]


def bump_connections(reader: "AnyReader", path: Path, topic: str | None) -> "list[Connection]":
    """Connections of a topic of bumps; without a topic, those of `BUMP_TOPICS` that can be read.

    Raises
    ------
    NotFoundError
        There is no such topic.
    InputError
        Messages of the topic do not say whether the robot bumped, or the bag does not define them.
    """
    if topic is None:
        return [
            one for one in reader.connections
            if one.topic in BUMP_TOPICS and one.msgtype in BUMP_TYPES and _defined(reader, one)
        ]  # fmt: skip
    found = [one for one in reader.connections if one.topic == topic]
    if not found:
        raise NotFoundError(f"{path}: no topic {topic!r} for bumps; leave it out, or name one of the bag's topics")
    for one in found:
        if one.msgtype not in BUMP_TYPES:
            raise InputError(f"bumps must have a type of {', '.join(BUMP_TYPES)}, got {one.msgtype} on {topic}")
        if not _defined(reader, one):
            raise InputError(f"the bag does not define {one.msgtype} of {topic}; record it as MCAP, or as "
                             "std_msgs/msg/Bool")  # fmt: skip
    return found


def _defined(reader: "AnyReader", connection: "Connection") -> bool:
    return connection.msgtype in reader.typestore.fielddefs
