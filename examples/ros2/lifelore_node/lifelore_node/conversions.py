"""Fields of ROS 2 messages from the files and answers of Lifelore, as plain data. Needs no ROS.

A message is a dict of its fields, as `rosidl_runtime_py.set_message.set_message_fields` takes it.
"""

import io
import json
import math
import shlex
import subprocess
from pathlib import Path
from typing import Any
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import numpy as np
import yaml
from PIL import Image

FLOAT32 = 7
"""`sensor_msgs/PointField.FLOAT32`."""
HIGHEST = 100
"""Largest occupancy; larger grey values of a raw map are unknown, -1 in a message."""


def occupancy_grid(path: str | Path) -> dict[str, Any]:
    """Fields of `nav_msgs/OccupancyGrid` from a map of mode raw, such as `costs.yaml`.

    A message has the lowest row first; a picture has the highest row first.
    """
    path = Path(path)
    settings = yaml.safe_load(path.read_text(encoding="utf-8"))
    if settings.get("mode") != "raw":
        raise ValueError(
            f"{path} must have mode raw, got {settings.get('mode')}; give a mask that Lifelore exported"
        )
    grey = np.asarray(Image.open(path.parent / settings["image"]), np.int16)
    x, y, yaw = settings["origin"]
    return {
        "info": {
            "resolution": float(settings["resolution"]),
            "width": grey.shape[1],
            "height": grey.shape[0],
            "origin": pose(x, y, yaw),
        },
        "data": np.where(grey <= HIGHEST, grey, -1)[::-1].ravel().astype(np.int8).tolist(),
    }


def way_fields(document: dict[str, Any], frame: str, stamp: dict[str, int]) -> dict[str, Any]:
    """Fields of `nav_msgs/Path` from what `lifelore way --json` prints."""
    header = {"stamp": stamp, "frame_id": frame}
    return {"header": header, "poses": [{"header": header, "pose": one["pose"]} for one in document["poses"]]}


def way_ends(text: str) -> tuple[str, str]:
    """Start and destination of a request for a way: JSON with the keys from and to, names or "X,Y" in metres."""
    try:
        request = json.loads(text)
        return str(request["from"]), str(request["to"])
    except (ValueError, KeyError, TypeError):
        raise ValueError(f'a way is asked for by {{"from": "dock", "to": "1.5,2"}}, got {text[:60]!r}') from None


def answer_of(program: str, *words: str | Path, seconds: float = 120.0) -> dict[str, Any]:
    """The JSON document that a command of Lifelore prints.

    Raises ValueError with the command's own line where it refuses, and OSError where there is no such program.
    """
    command = [program, *map(str, words), "--json"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        raise ValueError(f"{shlex.join(command)} took longer than {seconds:g} s") from None
    if done.returncode != 0:
        raise ValueError(done.stderr.strip() or f"{shlex.join(command)} left with {done.returncode}")
    return json.loads(done.stdout)


def memory_revision(url: str, token: str = "", seconds: float = 10.0) -> str:
    """A text that differs after each change of the service's memory; OSError if the service does not answer."""
    with urlopen(_request(f"{url}/v1/lives/revision", token), timeout=seconds) as answer:
        return json.load(answer)["revision"]


def pose(x: float, y: float, yaw: float) -> dict[str, Any]:
    """Fields of `geometry_msgs/Pose` on the floor."""
    turned = {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
    return {"position": {"x": float(x), "y": float(y), "z": 0.0}, "orientation": turned}


def cloud_points(message: Any) -> np.ndarray:
    """Points (n, 3) in metres of a `sensor_msgs/PointCloud2`; points that are not finite are left out."""
    offsets = {field.name: field.offset for field in message.fields if field.datatype == FLOAT32}
    missing = [name for name in "xyz" if name not in offsets]
    if missing:
        raise ValueError(f"the cloud must have the fields x, y and z of 32 bits, {missing[0]} is missing")
    order = ">" if message.is_bigendian else "<"
    layout = np.dtype({
        "names": list("xyz"), "formats": [order + "f4"] * 3, "offsets": [offsets[name] for name in "xyz"],
        "itemsize": message.point_step,
    })  # fmt: skip
    rows = np.frombuffer(bytes(message.data), np.uint8).reshape(message.height, message.row_step)
    used = np.ascontiguousarray(rows[:, : message.width * message.point_step])
    cloud = used.reshape(-1).view(layout)
    points = np.column_stack([cloud[name] for name in "xyz"]).astype(np.float32)
    return points[np.isfinite(points).all(axis=1)]


def perceived(url: str, points: np.ndarray, token: str = "", seconds: float = 60.0) -> dict[str, Any]:
    """The scene of a cloud as `POST /v1/perceive/cloud` of `lifelore serve` answers it.

    The camera stands at the origin of the points' frame, as in the optical frame of a depth camera.
    Raises ValueError with the words of the service where it refuses, and OSError where it does not answer.
    """
    file = io.BytesIO()
    np.savez(file, points=points, camera=np.zeros(3))
    request = _request(f"{url}/v1/perceive/cloud?format=npz", token, file.getvalue())
    try:
        with urlopen(request, timeout=seconds) as answer:
            return json.load(answer)
    except HTTPError as error:
        raise ValueError(json.load(error)["error"]["message"]) from None


def _request(url: str, token: str, body: bytes | None = None) -> Request:
    headers = {} if body is None else {"Content-Type": "application/octet-stream"}
    return Request(url, body, headers | ({"Authorization": f"Bearer {token}"} if token else {}))


def header_fields(header: Any) -> dict[str, Any]:
    """Fields of a `std_msgs/Header`, for messages of what was seen in it."""
    return {"stamp": {"sec": header.stamp.sec, "nanosec": header.stamp.nanosec}, "frame_id": header.frame_id}


def facts_text(scene: dict[str, Any]) -> dict[str, str]:
    """Fields of `std_msgs/String`: facts and warnings of a scene as JSON."""
    return {"data": json.dumps({"facts": scene["facts"], "warnings": scene["warnings"]})}
