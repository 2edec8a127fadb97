"""The frame of a scene: z up, z = 0 at the table, x to the camera's right."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.cloud_origin import CloudOrigin
from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, UNLABELLED, LabelledCloud
from lifelore.perception.clouds.cloud_scale import FAR, unit_hint
from lifelore.perception.clouds.pixel_camera import camera_from_pixels
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.clouds.voxel import thinned
from lifelore.perception.segmentation.camera_doubt import camera_at_origin, camera_doubt
from lifelore.perception.segmentation.cut_confidence import CutCloud
from lifelore.perception.segmentation.object_feet import with_feet
from lifelore.perception.segmentation.object_segmentation import TABLE_BAND, SegmentationSettings, cut_cloud
from lifelore.perception.segmentation.outline import over_outline
from lifelore.perception.segmentation.plane import NEAR, Plane, fitted_plane
from lifelore.perception.segmentation.range_noise import band
from lifelore.perception.segmentation.region import Region, empty_places, inside, over_table, reaching_out
from lifelore.perception.segmentation.table_evidence import REACH
from lifelore.perception.segmentation.table_search import Search, Table, find_table, no_table

Up = Literal["table", "z"] | ArrayLike
EVERYWHERE = Region()
MAX_OBJECTS = 60
"""Most objects of a cloud without labels; more come from a region that is too large."""
_FEW = 20


@dataclass(frozen=True, eq=False)
class SegmentedScene:
    """A cloud as a scene, with the evidence that its warnings are made of.

    Parameters
    ----------
    cloud : LabelledCloud
    automatic : bool
        Whether the objects were cut automatically; False where the cloud had labels.
    table : Table, optional
        The table that was searched for; None where labels name it, or where none was found.
    tilted : (3,) float64, optional
        In the frame of the cloud; see `table_search.Search`.
    confidence : mapping of int to float
        How surely each object was cut, see `CutCloud`; empty for a cloud with labels.
    camera_doubt : str, optional
        Why the position of the camera that the cloud gives is impossible; the cloud's camera is then that of its
        pixels, or unknown.
    up_given : bool
        Whether the upward direction was given, so that it is no result of the search for the table.
    """

    cloud: LabelledCloud
    automatic: bool
    table: Table | None = None
    tilted: NDArray[np.float64] | None = None
    confidence: Mapping[int, float] = field(default_factory=dict)
    camera_doubt: str | None = None
    up_given: bool = False


def to_scene(
    cloud: PointCloud, up: Up = "table", segmentation: SegmentationSettings | None = None
) -> LabelledCloud:
    """A cloud as a scene: upright, on its table, labelled; see `segmented_scene`.

    Examples
    --------
    >>> from lifelore import read_cloud
    >>> plane = np.stack(np.meshgrid(np.linspace(0, 1, 30), np.linspace(0, 1, 30)), -1).reshape(-1, 2)
    >>> table = np.column_stack([plane, np.full(900, 0.7), np.ones(900)])
    >>> block = np.column_stack([0.4 + 0.2 * plane, np.full(900, 0.8), np.full(900, 2)])
    >>> to_scene(read_cloud(np.concatenate([table, block])), up="z").of(2)[:, 2].mean().round(2)
    np.float64(0.1)
    """
    return segmented_scene(cloud, up, segmentation).cloud


def segmented_scene(
    cloud: PointCloud,
    up: Up = "table",
    segmentation: SegmentationSettings | None = None,
    region: Region = EVERYWHERE,
) -> SegmentedScene:
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
    region : Region, optional
        Where objects are looked for, in the frame of the cloud.

    Returns
    -------
    SegmentedScene
        Measured points of the region only, z = 0 at the table; `LabelledCloud.origin` leads back to the pixels and
        the frame of the cloud. Under ``up="table"`` and a vector, x is the camera's right seen from above and y
        leads away from it; under ``"z"`` x and y stay. Without a visible table, z = 0 is the lowest point but for
        1 % (a vector), or stays as it is (``"z"``). Where the camera is not given, or its position is impossible
        (see `camera_doubt`), the pixels of an organised cloud tell it (`pixel_camera`). Where it is not given
        and has no pixels, it is the origin if the points can be seen from there; else it is unknown.

    Raises
    ------
    InputError
        No point was measured in the region, the camera is beyond `cloud_scale.FAR`, `up` breaks its rule, no
        table can be found and up is unknown, or a cloud without labels has too many objects.
    """
    if not isinstance(cloud, PointCloud):
        raise InputError(f"cloud must be a PointCloud (read_cloud makes one), got {type(cloud).__name__}")
    _check_camera(cloud.camera)
    check_up(up)
    cloud = thinned(inside(cloud, region))
    measured = cloud.measured
    if not measured.any():
        raise InputError(f"the cloud holds no finite point among {len(cloud.points)}")
    cloud = cloud.only(measured)
    points = cloud.points.astype(np.float64)
    given = cloud.camera is not None
    seen = cloud if given else replace(cloud, camera=_likely_camera(points, cloud))
    scene, doubt = _seen_scene(points, seen, up, segmentation)
    if given and doubt is not None:
        seen = replace(cloud, camera=camera_from_pixels(cloud), other_cameras=None)
        scene, _ = _seen_scene(points, seen, up, segmentation)
    if scene is None:
        unseen = replace(cloud, camera=None, other_cameras=None)
        scene = _upright_scene(points, unseen, up, segmentation)
    return replace(scene, camera_doubt=doubt if given else None)


def _likely_camera(points: NDArray[np.float64], cloud: PointCloud) -> NDArray[np.float64] | None:
    """Where a camera that is not given must have been, or may have been; None where nothing tells."""
    found = camera_from_pixels(cloud)
    return camera_at_origin(points) if found is None else found


def _seen_scene(
    points: NDArray[np.float64],
    cloud: PointCloud,
    up: Up,
    segmentation: SegmentationSettings | None,
) -> tuple[SegmentedScene | None, str | None]:
    """The scene with the cloud's camera; none where its position is impossible, with the reason."""
    if cloud.camera is not None and cloud.other_cameras is None:
        doubt = camera_doubt(points, cloud.camera)
        if doubt is not None:
            return None, doubt
    scene = _upright_scene(points, cloud, up, segmentation)
    depth = _depth_below_table(scene.cloud)
    return (None, f"it would be {depth:.2f} m below the table") if depth > 0 else (scene, None)


def _depth_below_table(cloud: LabelledCloud) -> float:
    """Metres that the camera of a scene is below its table; 0 without a table or a camera.

    Also 0 where most of the objects are below the table: there it is rather up that is wrong.
    """
    heights = cloud.points[cloud.labels > TABLE, 2]
    if cloud.camera is None or not (cloud.labels == TABLE).any() or (len(heights) and np.median(heights) < 0):
        return 0.0
    return max(0.0, -float(cloud.camera[2]))


def _upright_scene(
    points: NDArray[np.float64],
    cloud: PointCloud,
    up: Up,
    segmentation: SegmentationSettings | None,
) -> SegmentedScene:
    """The scene of a cloud whose points are measured and within the region."""
    up_given = not (isinstance(up, str) and up == "table")
    search = _search(points, cloud, up)
    rotation, shift = _pose(points, cloud, up, search.table)
    scene_points = points @ np.ascontiguousarray(rotation.T)
    scene_points += shift
    camera = None if cloud.camera is None else rotation @ cloud.camera + shift
    others = None if cloud.other_cameras is None else cloud.other_cameras @ rotation.T + shift
    origin = _origin(cloud, rotation, shift)
    labels = cloud.labels if cloud.labels is not None and cloud.is_labelled else None
    if labels is not None:
        scene = LabelledCloud(scene_points, labels, cloud.colours, camera, others, origin)
        return SegmentedScene(scene, False, search.table, search.tilted, up_given=up_given)
    cut = _cut(points, scene_points, cloud, camera, search.table, segmentation or SegmentationSettings())
    _check_number(cut, search)
    scene = LabelledCloud(scene_points, cut.labels, cloud.colours, camera, others, origin)
    return SegmentedScene(scene, True, search.table, search.tilted, cut.confidence, up_given=up_given)


def _origin(cloud: PointCloud, rotation: NDArray[np.float64], shift: NDArray[np.float64]) -> CloudOrigin:
    """Where the points of the scene come from; their rows are unknown where one is a mean of several."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, shift
    rows = cloud.source_rows if cloud.source_rows is not None and cloud.source_rows.min() >= 0 else None
    return CloudOrigin(pose, cloud.frame, rows, cloud.grid)


def _check_camera(camera: NDArray[np.float64] | None) -> None:
    if camera is not None and np.abs(camera).max() > FAR:
        raise InputError(
            f"camera must stand within {FAR:.0e} m of the frame's origin, got {camera.tolist()}; leave it out"
        )


def _check_number(cut: CutCloud, search: Search) -> None:
    n, hint = len(np.unique(cut.labels[cut.labels > TABLE])), ""
    if search.table is None:
        # Of a cloud that stands askew, most objects are unsure and have joined their neighbours.
        n, hint = max(n, cut.n_cut), "check up, which no plane is level with (--up); "
    if n > MAX_OBJECTS:
        raise InputError(
            f"the cloud was cut into {n} objects, but at most {MAX_OBJECTS} are perceived; {hint}crop it to"
            " the table (--roi, --max-range), or give labels"
        )


def _cut(
    points: NDArray[np.float64],
    scene_points: NDArray[np.float64],
    cloud: PointCloud,
    camera: NDArray[np.float64] | None,
    table: Table | None,
    settings: SegmentationSettings,
) -> CutCloud:
    """Labels of the points over the table and of the table itself; of all points where there is no table.

    `camera` is in the scene's frame.
    """
    labels, bands = np.full(len(points), UNLABELLED, np.int64), band(points, cloud.camera)
    if table is None:
        chosen = np.arange(len(points))
        lift = np.array([0.0, 0.0, 2 * TABLE_BAND - scene_points[:, 2].min()])
        upright_points = scene_points + lift
        camera = None if camera is None else camera + lift
    else:
        on_it, over = over_table(points, bands, table)
        chosen = np.flatnonzero(on_it | over | reaching_out(points, bands, table, over))
        upright_points = scene_points.take(chosen, axis=0)
        # The band of a far table is wider than that of the segmentation: its points are laid onto the plane.
        upright_points[on_it[chosen], 2] = 0.0
    colours = None if cloud.colours is None else cloud.colours.take(chosen, axis=0)
    empty = None if table is None or camera is None else empty_places(scene_points, bands, camera)
    cut = cut_cloud(upright_points, colours, settings, camera, empty)
    labels[chosen] = cut.labels
    return replace(cut, labels=labels if table is None else with_feet(labels, scene_points, bands))


def table_plane(cloud: PointCloud) -> Plane:
    """The table's plane in the frame of the cloud, its normal on the side of the objects.

    Fitted to the points labelled as table, if any; else found by `table_search` among the unlabelled points.

    Raises
    ------
    InputError
        No table can be found.
    """
    cloud = cloud.only(cloud.measured)
    points = cloud.points.astype(np.float64)
    search = _search(points, cloud, "table")
    return _labelled_plane(points, cloud) if search.table is None else search.table.plane


def _has_table_label(labels: NDArray[np.int64] | None, at_least: int = 1) -> bool:
    return labels is not None and int(np.count_nonzero(labels == TABLE)) >= at_least


def _search(points: NDArray[np.float64], cloud: PointCloud, up: Up) -> Search:
    """The table of a cloud without a labelled table; without one where labels name it."""
    if _has_table_label(cloud.labels, 3 if isinstance(up, str) and up == "table" else 1):
        return Search(None)
    free = None if cloud.labels is None else cloud.labels == UNLABELLED
    direction = up_direction(up)
    search = find_table(points, cloud.camera, direction, free)
    if search.table is None and direction is None:
        raise no_table(_size_hint(points))
    return search


def _size_hint(points: NDArray[np.float64]) -> str:
    span = float(np.ptp(points, axis=0).max())
    return "" if span > 0.25 else f" (it spans {100 * span:.1f} cm: {unit_hint(span)})"


def _labelled_plane(points: NDArray[np.float64], cloud: PointCloud) -> Plane:
    """The plane of the points labelled as table; up is the side of the objects, without objects the camera's."""
    assert cloud.labels is not None
    plane = fitted_plane(points[cloud.labels == TABLE])
    objects = points[cloud.labels > TABLE]
    if len(objects):
        side = float(np.median(plane.height(objects)))
    else:
        side = _seen_side(points, plane)
        if side == 0.0 and cloud.camera is not None:
            side = float(plane.height(cloud.camera))
    return plane if side >= 0 else plane.flipped()


def _seen_side(points: NDArray[np.float64], plane: Plane) -> float:
    """+1, -1 or 0: the side of the plane where three quarters of the points over its outline stand.

    A table hides the points behind it, so points over its outline are on the camera's side.
    """
    flat = points @ upright(plane.normal)[:2].T
    height = plane.height(points)
    near = (np.abs(height) > NEAR) & (np.abs(height) < REACH)
    on_it = np.flatnonzero(np.abs(height) <= NEAR)
    near[near] = over_outline(flat[near], flat[on_it[:: max(1, len(on_it) // 5000)]])
    if np.count_nonzero(near) < _FEW:
        return 0.0
    above = np.mean(height[near] > 0)
    return 1.0 if above >= 0.75 else -1.0 if above <= 0.25 else 0.0


def _pose(
    points: NDArray[np.float64], cloud: PointCloud, up: Up, table: Table | None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rotation (3, 3) and shift (3,) from the frame of the cloud to the scene's."""
    if isinstance(up, str) and up == "table":
        plane = _labelled_plane(points, cloud) if table is None else table.plane
        return upright(plane.normal), np.array([0.0, 0.0, plane.offset])
    is_z = isinstance(up, str)
    normal = np.array([0.0, 0.0, 1.0]) if is_z else _unit(up)
    heights = points[:, 2] if is_z else points @ normal
    if _has_table_label(cloud.labels):
        height = float(np.median(heights[cloud.labels == TABLE]))
    elif table is not None:
        height = float(np.median(heights[over_table(points, band(points, cloud.camera), table)[0]]))
    else:
        height = 0.0 if is_z else float(np.percentile(heights, 1))
    return np.eye(3) if is_z else upright(normal), np.array([0.0, 0.0, -height])


def check_up(up: Up) -> None:
    """Raise InputError unless `up` is "table", "z" or a direction."""
    if not isinstance(up, str):
        _unit(up)
    elif up not in ("table", "z"):
        raise InputError(f"up must be 'table', 'z' or three numbers, got {up!r}")


def up_direction(up: Up) -> NDArray[np.float64] | None:
    """(3,) unit vector upwards; None under ``"table"``.

    Raises
    ------
    InputError
        `up` is no direction.
    """
    if isinstance(up, str):
        return np.array([0.0, 0.0, 1.0]) if up == "z" else None
    return _unit(up)


def _unit(up: ArrayLike) -> NDArray[np.float64]:
    try:
        vector = np.asarray(up, np.float64)
    except (TypeError, ValueError):
        raise InputError(f"up must be 'table', 'z' or three numbers, got {up!r}") from None
    length = np.linalg.norm(vector) if vector.shape == (3,) else 0.0
    if not (np.isfinite(length) and length > 0):
        raise InputError(f"up must be three finite numbers, not all zero, got {up!r}")
    return vector / length


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
