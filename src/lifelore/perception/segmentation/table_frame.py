"""The frame of a scene: z up, z = 0 at the table, x to the camera's right."""

from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, UNLABELLED, LabelledCloud
from lifelore.core.streams import stream
from lifelore.perception.clouds.cloud_scale import FAR
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.clouds.voxel import thinned
from lifelore.perception.segmentation.distance_segmentation import SegmentationSettings, cut_cloud
from lifelore.perception.segmentation.plane import NEAR, Plane, dominant_plane, over_outline

Up = Literal["table", "z"] | ArrayLike
_TABLE_SHARE = 0.10
_BELOW_SHARE = 0.02
_REACH = 0.6
_FEW = 20


def to_scene(
    cloud: PointCloud, up: Up = "table", segmentation: SegmentationSettings | None = None
) -> LabelledCloud:
    """A cloud as a scene: upright, on its table, labelled; see `to_cut_scene`."""
    return to_cut_scene(cloud, up, segmentation)[0]


def to_cut_scene(
    cloud: PointCloud, up: Up = "table", segmentation: SegmentationSettings | None = None
) -> tuple[LabelledCloud, Mapping[int, float]]:
    """A cloud as a scene: upright, on its table, labelled.

    Parameters
    ----------
    cloud : PointCloud
        In the sensor's frame. More than two million measured points are thinned to 3 mm voxels first.
    up : "table", "z", or (3,) numbers
        Up direction: the normal of the table's plane; the z axis of the frame, unchanged; or a vector of any
        length in the frame of the cloud.
    segmentation : SegmentationSettings, optional
        How an unlabelled cloud is segmented; a labelled cloud keeps its labels.

    Returns
    -------
    scene : LabelledCloud
        Measured points only, z = 0 at the table. Under ``up="table"`` and a vector, x is the camera's right
        seen from above and y leads away from it; under ``"z"`` x and y stay. Without a visible table, z = 0
        is the lowest point but for 1 % (a vector), or stays as it is (``"z"``).
    confidence : mapping of int to float
        How surely each object was cut, see `CutCloud`; empty for a cloud with labels.

    Raises
    ------
    InputError
        No point was measured, the camera is beyond `cloud_scale.FAR`, `up` breaks its rule, or no plane can be
        found.
    """
    _check_camera(cloud.camera)
    cloud = thinned(cloud)
    measured = cloud.measured
    if not measured.any():
        raise InputError(f"the cloud holds no finite point among {len(cloud.points)}")
    cloud = cloud.only(measured)
    points = cloud.points.astype(np.float64)
    rotation, shift = _pose(points, cloud, up)
    points = points @ rotation.T + shift
    camera = None if cloud.camera is None else rotation @ cloud.camera + shift
    others = None if cloud.other_cameras is None else cloud.other_cameras @ rotation.T + shift
    labels = cloud.labels if cloud.labels is not None and cloud.is_labelled else None
    if labels is not None:
        return LabelledCloud(points, labels, cloud.colours, camera, others), {}
    cut = cut_cloud(points, cloud.colours, segmentation or SegmentationSettings(), camera)
    return LabelledCloud(points, cut.labels, cloud.colours, camera, others), cut.confidence


def _check_camera(camera: NDArray[np.float64] | None) -> None:
    if camera is not None and np.abs(camera).max() > FAR:
        raise InputError(
            f"camera must stand within {FAR:.0e} m of the frame's origin, got {camera.tolist()}; leave it out"
        )


def table_plane(cloud: PointCloud) -> Plane:
    """The table's plane in the frame of the cloud, its normal on the side of the objects.

    Found among the points labelled as table, if any, else among the unlabelled points. The normal points to the
    labelled objects; without labels to the side with three quarters of the points over the plane's outline, else
    to the camera.

    Raises
    ------
    InputError
        No plane can be found.
    """
    points = cloud.points[cloud.measured].astype(np.float64)
    labels = None if cloud.labels is None else cloud.labels[cloud.measured]
    return _table_plane(points, labels, cloud.camera)


def _table_plane(
    points: NDArray[np.float64], labels: NDArray[np.int64] | None, camera: NDArray[np.float64] | None
) -> Plane:
    candidates = _table_candidates(points, labels)
    plane, _ = dominant_plane(candidates, stream(0, "perception", "table plane"))
    objects = None if labels is None else points[labels > TABLE]
    if objects is not None and len(objects):
        side = float(np.median(plane.height(objects)))
    else:
        side = _seen_side(points, plane)
        if side == 0.0 and camera is not None:
            side = float(plane.height(camera))
    return plane if side >= 0 else plane.flipped()


def _table_candidates(points: NDArray[np.float64], labels: NDArray[np.int64] | None) -> NDArray[np.float64]:
    """Candidate points of the table's plane: those labelled as table, else the unlabelled."""
    if labels is None or not labels.any():
        return points
    for mask in (labels == TABLE, labels == UNLABELLED):
        if np.count_nonzero(mask) >= 3:
            return points[mask]
    raise InputError("no point is labelled as table or left over, so up is not known; give up as a vector or 'z'")


def _seen_side(points: NDArray[np.float64], plane: Plane) -> float:
    """+1, -1 or 0: the side of the plane where three quarters of the points over its outline stand.

    A table hides the points behind it, so points over its outline are on the camera's side.
    """
    flat = points @ upright(plane.normal)[:2].T
    height = plane.height(points)
    near = (np.abs(height) > NEAR) & (np.abs(height) < _REACH)
    on_it = np.flatnonzero(np.abs(height) <= NEAR)
    near[near] = over_outline(flat[near], flat[on_it[:: max(1, len(on_it) // 5000)]])
    if np.count_nonzero(near) < _FEW:
        return 0.0
    above = np.mean(height[near] > 0)
    return 1.0 if above >= 0.75 else -1.0 if above <= 0.25 else 0.0


def _pose(
    points: NDArray[np.float64], cloud: PointCloud, up: Up
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rotation (3, 3) and shift (3,) from the frame of the cloud to the scene's."""
    check_up(up)
    if isinstance(up, str):
        if up == "table":
            plane = _table_plane(points, cloud.labels, cloud.camera)
            return upright(plane.normal), np.array([0.0, 0.0, plane.offset])
        table = _table_height(points[:, 2], points, np.array([0.0, 0.0, 1.0]), cloud.labels)
        return np.eye(3), np.array([0.0, 0.0, 0.0 if table is None else -table])
    normal = _unit(up)
    heights = points @ normal
    table = _table_height(heights, points, normal, cloud.labels)
    return upright(normal), np.array([0.0, 0.0, -float(np.percentile(heights, 1)) if table is None else -table])


def check_up(up: Up) -> None:
    """Raise InputError unless `up` is "table", "z" or a direction."""
    if not isinstance(up, str):
        _unit(up)
    elif up not in ("table", "z"):
        raise InputError(f"up must be 'table', 'z' or three numbers, got {up!r}")


def _unit(up: ArrayLike) -> NDArray[np.float64]:
    try:
        vector = np.asarray(up, np.float64)
    except (TypeError, ValueError):
        raise InputError(f"up must be 'table', 'z' or three numbers, got {up!r}") from None
    length = np.linalg.norm(vector) if vector.shape == (3,) else 0.0
    if not (np.isfinite(length) and length > 0):
        raise InputError(f"up must be three finite numbers, not all zero, got {up!r}")
    return vector / length


def _table_height(
    heights: NDArray[np.float64], points: NDArray[np.float64], normal: NDArray[np.float64], labels: NDArray | None
) -> float | None:
    """Height of the table along a known up: of its labels, else of a broad level plane with few points below."""
    if labels is not None and (labels == TABLE).any():
        return float(np.median(heights[labels == TABLE]))
    free = np.ones(len(points), bool) if labels is None else labels < TABLE
    if np.count_nonzero(free) < 3:
        return None
    try:
        plane, _ = dominant_plane(points[free], stream(0, "perception", "table height"), up=normal)
    except InputError:
        return None
    on_it = np.abs(plane.height(points)) <= NEAR
    level = float(np.median(heights[on_it])) if on_it.any() else np.inf
    below = np.mean(heights < level - 3 * NEAR)
    return level if on_it.mean() >= _TABLE_SHARE and below <= _BELOW_SHARE else None


def upright(normal: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3, 3) rotation that turns `normal` to z and the frame's x as near to x as that allows.

    In a camera's frame (x right, y down, z forward) x stays the camera's right, and y leads away from it.
    """
    x = np.array([1.0, 0.0, 0.0])
    if abs(normal[0]) > 0.95:
        x = np.array([0.0, 0.0, 1.0])
    x = x - (x @ normal) * normal
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(normal, x), normal])
