"""Fields of ROS 2 messages of a perceived scene: `vision_msgs/Detection3DArray` and typed relations.

Needs no ROS, and nothing but Python's own library: a robot's node may take this file alone.
"""

from collections.abc import Mapping, Sequence
from typing import Any

NO_FRAME = "camera"
"""Name of the camera's frame where the cloud did not name it."""


def header(document: Mapping[str, Any]) -> dict[str, Any]:
    """Fields of `std_msgs/Header` of a scene: name and time of the camera's frame; time 0 where it is unknown."""
    return header_at(document["frame"]["name"] or NO_FRAME, document["frame"]["stamp"] or 0.0)


def header_at(frame: str, seconds: float) -> dict[str, Any]:
    """Fields of `std_msgs/Header` of a frame at a time."""
    whole, part = divmod(seconds, 1.0)
    more, nanoseconds = divmod(round(part * 1e9), 10**9)
    return {"stamp": {"sec": int(whole) + more, "nanosec": nanoseconds}, "frame_id": frame}


def detection_array(document: Mapping[str, Any], head: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Fields of `vision_msgs/Detection3DArray`: the box of each object in the camera's frame.

    Parameters
    ----------
    document : mapping
        The document of `perceive`.
    head : mapping, optional
        Fields of the header; default: those of `header`.

    Returns
    -------
    dict
        A detection's ``id`` is the object's number, its only hypothesis the class ``object`` with the confidence
        of the cut (1 where the cloud was labelled). The box is of the visible points.
    """
    head = header(document) if head is None else head
    return {"header": head, "detections": [_detection(one, head) for one in document["objects"]]}


def _detection(one: Mapping[str, Any], head: Mapping[str, Any]) -> dict[str, Any]:
    box = one["box_camera"]
    pose = {"position": _vector(box["centre"]), "orientation": quaternion(box["axes"])}
    hypothesis = {"class_id": "object", "score": float(one.get("cut_confidence", 1.0))}
    return {
        "header": head,
        "results": [{"hypothesis": hypothesis, "pose": {"pose": pose, "covariance": [0.0] * 36}}],
        "bbox": {"center": pose, "size": _vector(box["size"])},
        "id": str(one["id"]),
    }


def relation_array(document: Mapping[str, Any], head: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Fields of `lifelore_msgs/SpatialRelationArray`: the relations of a scene, without *none*.

    Objects are named as the detections' ``id``, and the table ``table``. An unknown gap is NaN.
    """
    relations = [
        {
            "a": str(one["a"]),
            "b": str(one["b"]),
            "relation": one["relation"],
            "confidence": float(one["confidence"]),
            "gap": float("nan") if one["gap"] is None else float(one["gap"]),
            "stated": bool(one["stated"]),
        }
        for one in document["relations"]
        if one["relation"] != "none"
    ]
    return {"header": header(document) if head is None else head, "relations": relations}


def transform(motion: Sequence[Sequence[float]]) -> dict[str, Any]:
    """Fields of `geometry_msgs/Transform` of a 4 × 4 motion."""
    columns = list(zip(*(row[:3] for row in motion[:3]), strict=True))
    return {"translation": _vector([row[3] for row in motion[:3]]), "rotation": quaternion(columns)}


def quaternion(axes: Sequence[Sequence[float]]) -> dict[str, float]:
    """Fields of `geometry_msgs/Quaternion` of the turn whose axes are these three unit vectors (right-handed)."""
    (xx, yx, zx), (xy, yy, zy), (xz, yz, zz) = axes
    # Four times the squares of x, y, z and w: the largest is divided by (Shepperd, 1978).
    squares = [1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz, 1 + xx + yy + zz]
    largest = max(range(4), key=squares.__getitem__)
    products = (
        (squares[0], yx + xy, zx + xz, zy - yz),
        (yx + xy, squares[1], zy + yz, xz - zx),
        (zx + xz, zy + yz, squares[2], yx - xy),
        (zy - yz, xz - zx, yx - xy, squares[3]),
    )[largest]
    length = sum(value * value for value in products) ** 0.5
    return {name: value / length for name, value in zip("xyzw", products, strict=True)}


def _vector(values: Sequence[float]) -> dict[str, float]:
    return {name: float(value) for name, value in zip("xyz", values, strict=True)}
