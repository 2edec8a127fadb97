"""Logs a life in a building as an MCAP file of ROS 2 messages, for Foxglove and ``ros2 bag``; extra ``ros``.

All is in the frame map: ``/map`` and ``/lifelore/costs`` are OccupancyGrids, ``/lifelore/way`` has a Path for each
way, and ``/lifelore/events`` a MarkerArray for each event, with its point and its name.
"""

import math
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.bridges.detection3d import header_at
from lifelore.bridges.mcap_file import mcap_writer
from lifelore.domains.buildings.logged_life import LoggedLife
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, OccupancyMap

FRAME = "map"
SPHERE, TEXT = 2, 9
"""Kinds of `visualization_msgs/Marker`."""
RED, GREEN, BLACK = (0.8, 0.1, 0.1, 1.0), (0.1, 0.6, 0.2, 1.0), (0.0, 0.0, 0.0, 1.0)
SIZE = 0.25
"""Metres: diameter of an event's point, and height of its name."""


def write_life_mcap(path: str | Path, life: LoggedLife) -> None:
    """Write a life, ways and events in order of time; see `write_life_log`.

    Raises
    ------
    MissingExtraError
        rosbags is not installed.
    OSError
        The file cannot be written.
    """
    occupancy = life.occupancy
    first = min((seconds for _, seconds, _ in [*life.ways, *life.events]), default=0.0)
    seen = np.select([occupancy.state == FREE, occupancy.state == OCCUPIED], [0, 100], 255).astype(np.uint8)
    with mcap_writer(Path(path), {}) as write:
        for topic, grey in (("/map", seen), ("/lifelore/costs", life.costs)):
            write(topic, "nav_msgs/msg/OccupancyGrid", _grid(occupancy, grey, first), _nanoseconds(first))
        for _, seconds, points in life.ways:
            write("/lifelore/way", "nav_msgs/msg/Path", _path(points, seconds), _nanoseconds(seconds))
        for number, (name, seconds, point) in enumerate(life.events):
            markers = {"markers": _markers(number, name, point, seconds)}
            write("/lifelore/events", "visualization_msgs/msg/MarkerArray", markers, _nanoseconds(seconds))


def _nanoseconds(seconds: float) -> int:
    return round(seconds * 1e9)


def _grid(occupancy: OccupancyMap, grey: NDArray[np.uint8], seconds: float) -> dict[str, Any]:
    """A grid has the lowest row first; values above 100 are unknown."""
    rows, columns = grey.shape
    about = {
        "resolution": occupancy.resolution,
        "width": columns,
        "height": rows,
        "origin": _pose(*occupancy.origin),
    }
    data = np.where(grey <= 100, grey.astype(np.int8), -1)[::-1].ravel()
    return {"header": header_at(FRAME, seconds), "info": about, "data": data}


def _path(points: NDArray[np.float64], seconds: float) -> dict[str, Any]:
    """Each pose faces the next; the last one has the heading of the pose before it."""
    headings = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in pairwise(points.tolist())]
    headings = [*headings, headings[-1] if headings else 0.0]
    header = header_at(FRAME, seconds)
    poses = [
        {"header": header, "pose": _pose(x, y, yaw)} for (x, y), yaw in zip(points.tolist(), headings, strict=True)
    ]
    return {"header": header, "poses": poses}


def _pose(x: float, y: float, yaw: float) -> dict[str, Any]:
    turned = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
    return {"position": {"x": x, "y": y}, "orientation": turned}


def _markers(number: int, name: str, point: tuple[float, float], seconds: float) -> list[dict[str, Any]]:
    """A point, red for what was refused, and its name above it."""
    about: Mapping[str, Any] = {
        "header": header_at(FRAME, seconds), "id": number, "pose": _pose(*point, 0.0),
        "scale": dict.fromkeys("xyz", SIZE),
    }  # fmt: skip
    colour = RED if name.startswith("refused") else GREEN
    dot = {"ns": "events", "type": SPHERE, "color": dict(zip("rgba", colour, strict=True))}
    text = {"ns": "names", "type": TEXT, "text": name, "color": dict(zip("rgba", BLACK, strict=True))}
    return [{**about, **dot}, {**about, **text}]
