"""Logs a perceived scene as an MCAP file of ROS 2 messages, as Foxglove and ``ros2 bag`` read it; extra ``ros``.

Everything is in the camera's frame; ``/tf_static`` holds the scene's frame in it. Topics: ``/lifelore/points``,
``/lifelore/detections``, ``/lifelore/relations`` and ``/lifelore/markers`` (boxes, contact points and edges).
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lifelore.bridges.detection3d import detection_array, header, relation_array, transform
from lifelore.bridges.mcap_file import mcap_writer
from lifelore.core.labelled_cloud import TABLE

if TYPE_CHECKING:
    from lifelore.core.labelled_cloud import LabelledCloud
    from lifelore.perception.scene import Scene

SCENE_FRAME = "lifelore_scene"
DEFINITIONS = {
    "vision_msgs/msg/ObjectHypothesis": "string class_id\nfloat64 score",
    "vision_msgs/msg/ObjectHypothesisWithPose": (
        "vision_msgs/ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose"
    ),
    "vision_msgs/msg/BoundingBox3D": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size",
    "vision_msgs/msg/Detection3D": (
        "std_msgs/Header header\nvision_msgs/ObjectHypothesisWithPose[] results\n"
        "vision_msgs/BoundingBox3D bbox\nstring id"
    ),
    "vision_msgs/msg/Detection3DArray": "std_msgs/Header header\nvision_msgs/Detection3D[] detections",
    "lifelore_msgs/msg/SpatialRelation": (
        "string a\nstring b\nstring relation\nfloat64 confidence\nfloat64 gap\nbool stated"
    ),
    "lifelore_msgs/msg/SpatialRelationArray": (
        "std_msgs/Header header\nlifelore_msgs/SpatialRelation[] relations"
    ),
}
"""Messages that ROS 2 itself does not define: vision_msgs 4, and those of examples/ros2/lifelore_msgs."""
CUBE, LINE_LIST, SPHERE_LIST = 1, 5, 7
"""Kinds of `visualization_msgs/Marker`."""
GREEN, BLACK = (0.2, 0.6, 0.4, 0.3), (0.0, 0.0, 0.0, 1.0)
_LAYOUT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgb", "<u4"), ("label", "<u4")])
_FLOAT32, _UINT32 = 7, 6


def write_scene_mcap(path: str | Path, scene: "Scene", document: Mapping[str, Any]) -> None:
    """Write a scene and its document; a file of this name is replaced.

    Raises
    ------
    MissingExtraError
        rosbags is not installed.
    OSError
        The file cannot be written.
    """
    head = header(document)
    stamp = head["stamp"]["sec"] * 10**9 + head["stamp"]["nanosec"]
    pose = {"header": head, "child_frame_id": SCENE_FRAME}
    pose["transform"] = transform(document["frame"]["camera_from_scene"])
    with mcap_writer(Path(path), DEFINITIONS) as write:
        write("/tf_static", "tf2_msgs/msg/TFMessage", {"transforms": [pose]}, stamp)
        write("/lifelore/points", "sensor_msgs/msg/PointCloud2", _points(scene.cloud, head), stamp)
        write("/lifelore/detections", "vision_msgs/msg/Detection3DArray", detection_array(document), stamp)
        relations = relation_array(document)
        write("/lifelore/relations", "lifelore_msgs/msg/SpatialRelationArray", relations, stamp)
        markers = {"markers": _markers(scene, document, head)}
        write("/lifelore/markers", "visualization_msgs/msg/MarkerArray", markers, stamp)


def _points(cloud: "LabelledCloud", head: Mapping[str, Any]) -> dict[str, Any]:
    rows = np.zeros(len(cloud.points), _LAYOUT)
    rows["x"], rows["y"], rows["z"] = cloud.origin.in_camera(cloud.points).T
    colours = np.full((len(rows), 3), 128) if cloud.colours is None else cloud.colours.astype(np.uint32)
    rows["rgb"], rows["label"] = colours @ [1 << 16, 1 << 8, 1], cloud.labels
    kinds = dict.fromkeys("xyz", _FLOAT32) | {"rgb": _FLOAT32, "label": _UINT32}
    fields = [
        {"name": name, "offset": 4 * place, "datatype": kind, "count": 1}
        for place, (name, kind) in enumerate(kinds.items())
    ]
    size = {"height": 1, "width": len(rows), "point_step": _LAYOUT.itemsize, "row_step": rows.nbytes}
    return {"header": head, **size, "fields": fields, "data": rows.view(np.uint8), "is_dense": True}


def _markers(scene: "Scene", document: Mapping[str, Any], head: Mapping[str, Any]) -> list[dict[str, Any]]:
    contacts = {one["id"]: [node["xyz_camera"] for node in one["contact_points"]] for one in document["objects"]}
    table = scene.networks.get(TABLE)
    contacts["table"] = [scene.cloud.origin.in_camera(node.position) for node in table.nodes] if table else []
    ends = [contacts[label][node] for edge in document["contact_edges"] for label, node in edge]
    boxes = [
        _marker(head, "boxes", number, CUBE, found["bbox"]["size"], GREEN, found["bbox"]["center"])
        for number, found in enumerate(detection_array(document)["detections"])
    ]
    points = [place for places in contacts.values() for place in places]
    dots = _marker(head, "contacts", 0, SPHERE_LIST, dict.fromkeys("xyz", 0.005), BLACK, places=points)
    lines = _marker(head, "contact_edges", 0, LINE_LIST, {"x": 0.002}, BLACK, places=ends)
    return [*boxes, dots, lines]


def _marker(
    head: Mapping[str, Any], group: str, number: int, kind: int, scale: Mapping[str, float],
    colour: Sequence[float], pose: Mapping[str, Any] | None = None, places: Sequence[Any] = (),
) -> dict[str, Any]:  # fmt: skip
    return {
        "header": head, "ns": group, "id": number, "type": kind, "scale": scale,
        "pose": pose or {"orientation": {"w": 1.0}}, "color": dict(zip("rgba", colour, strict=True)),
        "points": [dict(zip("xyz", map(float, place), strict=True)) for place in places],
    }  # fmt: skip
