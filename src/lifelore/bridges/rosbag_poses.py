"""Reads the log of a robot from a rosbag: poses in the map, goals and bumps; needs the extra ``ros``.

Without a topic, poses are those of the base in the map, from ``/tf``; where no transforms join the two, those of
the only topic with poses. Poses in another frame than the map's are transformed by ``/tf``.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.bridges.rosbag import bag_errors, opened_bag, topic_of
from lifelore.bridges.rosbag_events import Bumps, Goals, bump_connections, goal_connections
from lifelore.bridges.rosbag_frames import FrameTree, composed, frame_name, planar, seconds
from lifelore.core.errors import InputError

if TYPE_CHECKING:
    from lifelore.bridges.rosbag import AnyReader, Connection

MAP, BASES = "map", ("base_link", "base_footprint")
"""Frame of the map, and frames of the robot."""
SHORTEST = 0.1
"""Seconds: a pose that follows another one sooner is left out."""
_TF, _TF_STATIC, _TF_TYPES = "/tf", "/tf_static", ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
_POSE_TYPES = (
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "nav_msgs/msg/Odometry",
)


class BagLog(NamedTuple):
    """Poses in order of time, and how the runs went.

    time : (n,) seconds
    points : (n, 2) x and y in metres of the frame of the map
    heading : (n,) radians about the vertical axis, 0 along x
    outcome : n texts, as in the column ``outcome`` of a CSV log: bump, goal, failed or empty
    ends : (n,) bool, whether a run ends with this pose
    """

    time: NDArray[np.float64]
    points: NDArray[np.float64]
    heading: NDArray[np.float64]
    outcome: list[str]
    ends: NDArray[np.bool_]


class _Poses(NamedTuple):
    """Rows (n, 4) of seconds, x, y and yaw; `delay`, seconds from a stamp until the recorder got the message."""

    rows: NDArray[np.float64]
    delay: float


def read_bag_log(path: str | Path, topic: str | None = None, bumps: str | None = None) -> BagLog:
    """The log of a robot in a bag.

    Parameters
    ----------
    path : str or Path
    topic : str, optional
        Topic of the poses; ``/tf``: the base in the map. Default: see above.
    bumps : str, optional
        Topic of the bumps; default: ``/bump`` and ``/bumper``, where the bag has them.

    Raises
    ------
    MissingExtraError
        rosbags is not installed.
    NotFoundError
        A topic does not exist, or several topics have poses and none is named.
    InputError
        The bag is missing, damaged or without a pose, a pose is not finite, or no transform joins its frame and
        the map.
    """
    path = Path(path)
    with bag_errors(path), opened_bag(path) as reader:
        frames, delay = _frames(reader)
        chain = _base_chain(frames) if topic in (None, _TF) else None
        if chain:
            stamps = frames.stamps(chain)
            poses = _Poses(np.column_stack([stamps, frames.poses(chain, stamps)]), delay)
        elif topic == _TF:
            raise InputError(f"{_TF} joins {' and '.join(BASES)} with no frame {MAP!r}; name a topic of poses")
        else:
            chosen = topic_of(reader, path, _POSE_TYPES, "poses", topic)
            poses = _in_map(*_of_topic(reader, chosen), frames, chosen[0].topic)
        goals, pressed = _events(reader, path, bumps)
    return _log(_thinned(poses.rows), [(time - poses.delay, word) for time, word in goals],
                [time - poses.delay for time in pressed])  # fmt: skip


def _messages(reader: "AnyReader", chosen: "list[Connection]") -> Iterator[tuple[str, str, float, Any]]:
    """(topic, type, seconds of receipt, message) in order of receipt; rosbags takes no topics for all topics."""
    for connection, nanoseconds, content in reader.messages(chosen) if chosen else ():
        message = reader.deserialize(content, connection.msgtype)
        yield connection.topic, connection.msgtype, nanoseconds * 1e-9, message


def _frames(reader: "AnyReader") -> tuple[FrameTree, float]:
    frames, delays = FrameTree(), [0.0]
    chosen = [one for one in reader.connections if one.topic in (_TF, _TF_STATIC) and one.msgtype in _TF_TYPES]
    for topic, _, received, message in _messages(reader, chosen):
        frames.add(message.transforms, topic == _TF_STATIC)
        if topic == _TF and message.transforms:
            delays.append(received - seconds(message.transforms[-1].header.stamp))
    return frames, float(np.median(delays[1:] or delays))


def _base_chain(frames: FrameTree) -> list[str] | None:
    """The frames from the robot's base up to the map, if one of them moves."""
    chains = [chain for base in BASES if (chain := frames.chain(base, MAP))]
    return next((chain for chain in chains if len(frames.stamps(chain))), None)


def _of_topic(reader: "AnyReader", chosen: "list[Connection]") -> tuple[_Poses, str]:
    """The poses of a topic, and their frame; a message without a stamp counts when it was received."""
    rows, delays, frame = [], [], MAP
    for _, _, received, message in _messages(reader, chosen):
        pose = getattr(message.pose, "pose", message.pose)  # with a covariance, the pose lies one level deeper
        stamp = seconds(message.header.stamp) or received
        rows.append((stamp, *planar(pose.position, pose.orientation)))
        delays.append(received - stamp)
        frame = frame_name(message.header.frame_id)
    if not rows:
        raise InputError("holds no pose")
    return _Poses(np.array(rows), float(np.median(delays))), frame


def _in_map(poses: _Poses, frame: str, frames: FrameTree, topic: str) -> _Poses:
    if not np.isfinite(poses.rows).all():
        raise InputError("a pose has a coordinate that is no finite number")
    if frame == MAP:
        return poses
    chain = frames.chain(frame, MAP)
    if chain is None:
        raise InputError(
            f"poses on {topic} are in the frame {frame!r}, and the bag has no transform from {MAP!r} to {frame!r};"
            f" record {_TF} and {_TF_STATIC} too, or name a topic whose frame is {MAP!r}"
        )
    stamps = poses.rows[:, 0]
    return _Poses(np.column_stack([stamps, composed(frames.poses(chain, stamps), poses.rows[:, 1:])]), poses.delay)


def _thinned(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """The rows in order of time whose transforms are known, `SHORTEST` apart at least."""
    rows = rows[np.isfinite(rows).all(axis=1)]
    if not len(rows):
        raise InputError("no pose has a transform to the map at its time; record /tf from the start of the drive")
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    kept = [0]
    for i in range(1, len(rows)):
        if rows[i, 0] - rows[kept[-1], 0] >= SHORTEST * (1 - 1e-6):
            kept.append(i)
    return rows[kept]


def _events(reader: "AnyReader", path: Path, bumps: str | None) -> tuple[list[tuple[float, str]], list[float]]:
    """Seconds of receipt and outcome of goals, and seconds of bumps."""
    goals, pressed = Goals(), Bumps()
    bumpers = bump_connections(reader, path, bumps)
    named = {one.topic for one in bumpers}
    for topic, msgtype, received, message in _messages(reader, [*goal_connections(reader), *bumpers]):
        if topic in named:
            pressed.add(received, msgtype, message)
        else:
            goals.add(received, message)
    return goals.events, pressed.times


def _log(rows: NDArray[np.float64], goals: list[tuple[float, str]], pressed: list[float]) -> BagLog:
    """Events belong to the last pose before them, begins to the last pose of another time, if there is one."""
    outcome, ends = [""] * len(rows), np.zeros(len(rows), bool)
    events = [*((time, "bump", False) for time in pressed), *((*goal, True) for goal in goals)]
    for time, word, ended in events:
        last = int(np.searchsorted(rows[:, 0], time, side="right" if word else "left")) - 1
        if last >= 0:
            ends[last] |= ended
            if outcome[last] == "bump" and word == "goal" and last:
                outcome[last - 1] = "bump"
            # A run that ends with a bump has failed.
            outcome[last] = "bump" if outcome[last] == "bump" and word == "failed" else word or outcome[last]
    return BagLog(rows[:, 0], rows[:, 1:3], rows[:, 3], outcome, ends)
