"""The region of a cloud in which objects are looked for: a box, a range, and the space over the table."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.perception.clouds.connected_parts import connected_parts
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.clouds.voxel import box_of, voxels_of
from lifelore.perception.segmentation.surface_patches import Patch
from lifelore.perception.segmentation.table_evidence import FRINGE, REACH
from lifelore.perception.segmentation.table_search import Table

AXES = ("XMIN", "XMAX", "YMIN", "YMAX", "ZMIN", "ZMAX")
OVERHANG = 0.30
"""Metres that an object on the table may reach beyond the table's visible outline."""
_INSIDE_SHARE = 0.5
_LINK = 0.02
"""Metres: cells of this side that touch are linked."""


@dataclass(frozen=True)
class Region:
    """Where objects are looked for.

    Parameters
    ----------
    roi : six numbers, optional
        XMIN, XMAX, YMIN, YMAX, ZMIN, ZMAX in metres, in the frame of the cloud; points outside are dropped.
    max_range : float, optional
        Metres from the camera, or from the origin where the camera is unknown; points beyond are dropped.

    Raises
    ------
    InputError
        A value breaks its rule.
    """

    roi: Sequence[float] | None = None
    max_range: float | None = None

    def __post_init__(self) -> None:
        if self.roi is not None:
            _check_roi(self.roi)
        if self.max_range is not None and not (np.isfinite(self.max_range) and self.max_range > 0):
            raise InputError(f"max_range must be a positive number of metres, got {self.max_range}")


def _check_roi(roi: Sequence[float]) -> None:
    low, high = np.asarray(roi[::2], float), np.asarray(roi[1::2], float)
    if len(roi) != 6 or np.isnan([*low, *high]).any():
        raise InputError(f"roi must be six numbers {','.join(AXES)}, got {','.join(map(str, roi))}")
    for axis in range(3):
        if not low[axis] < high[axis]:
            raise InputError(
                f"roi must have {AXES[2 * axis]} < {AXES[2 * axis + 1]}, got {low[axis]:g} and {high[axis]:g}"
            )


def inside(cloud: PointCloud, region: Region) -> PointCloud:
    """The measured points of a cloud that are in the region; the cloud itself where the region has no limit.

    Raises
    ------
    InputError
        No point is in the region.
    """
    if region.roi is None and region.max_range is None:
        return cloud
    keep = cloud.measured
    if region.roi is not None:
        low, high = np.asarray(region.roi, float).reshape(3, 2).T
        with np.errstate(invalid="ignore"):
            keep &= ((cloud.points >= low) & (cloud.points <= high)).all(axis=1)
    if region.max_range is not None:
        centre = np.zeros(3) if cloud.camera is None else cloud.camera
        with np.errstate(invalid="ignore"):
            keep &= np.linalg.norm(cloud.points - centre, axis=1) <= region.max_range
    if not keep.any():
        low, high = np.nanmin(cloud.points, axis=0), np.nanmax(cloud.points, axis=0)
        spans = ", ".join(f"{a} {x:.2f} to {y:.2f}" for a, x, y in zip("xyz", low, high, strict=True))
        raise InputError(
            f"the region (roi, max_range) holds no point of the cloud, which spans {spans} m; widen it"
        )
    return cloud.only(keep)


def over_table(
    points: NDArray[np.float64], bands: NDArray[np.float64], table: Table
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which points (n, 3) are the table, and which stand over it; both (n,) bool.

    The table's points lie within the band of its plane and within its outline. Points over it are up to `REACH`
    above the band. Points of walls and furniture are left out: large flat patches that are mostly not over it.
    """
    heights = table.plane.height(points)
    low = _covered((heights >= -bands) & (heights <= REACH), points, table.patch)
    on_it = low & (heights <= bands)
    over = low & ~on_it
    for patch in table.background:
        near = _covered(np.abs(patch.plane.height(points)) <= bands, points, patch)
        if np.count_nonzero(near & over) < _INSIDE_SHARE * np.count_nonzero(near):
            over &= ~near
    return on_it, over


def reaching_out(
    points: NDArray[np.float64], bands: NDArray[np.float64], table: Table, over: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """(n,) bool: points beyond the table's visible outline that are linked to points `over` (n,) it.

    The visible part of a table is not the whole: an object hides the table behind it, the picture ends, and an
    object may overhang. Large flat patches (walls, furniture) are left out.
    """
    heights = table.plane.height(points)
    beyond = _covered((heights > bands) & (heights <= REACH) & ~over, points, table.patch, OVERHANG)
    at_border = _covered(beyond, points, table.patch, _LINK)
    beyond &= ~_covered(at_border, points, table.patch)
    for patch in table.background:
        near = np.flatnonzero(beyond)
        near = near[np.abs(patch.plane.height(points[near])) <= FRINGE * bands[near]]
        beyond[near[patch.covers(points[near], _LINK)]] = False
    among = np.flatnonzero(over | beyond)
    cluster = _linked(points[among])
    met = np.bincount(cluster[(over | at_border)[among]], minlength=int(cluster.max(initial=-1)) + 1) > 0
    beyond[among] &= met[cluster]
    return beyond


def empty_places(
    points: NDArray[np.float64], bands: NDArray[np.float64], camera: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(m, 2) places where the camera sees through the plane z = 0: something below it was measured there."""
    below = points[points[:, 2] < -2 * bands]
    if camera[2] <= 0:
        return below[:, :2]
    return camera[:2] + (below[:, :2] - camera[:2]) * (camera[2] / (camera[2] - below[:, 2:]))


def _covered(
    which: NDArray[np.bool_], points: NDArray[np.float64], patch: Patch, margin: float = 0.0
) -> NDArray[np.bool_]:
    """(n,) bool: those of `which` points (n, 3) that lie over or under the outline of a patch."""
    places = np.flatnonzero(which)
    covered = np.zeros(len(which), bool)
    covered[places[patch.covers(points.take(places, axis=0), margin)]] = True
    return covered


def _linked(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """(n,) number of the cluster of each point: cells of `_LINK` that touch are one cluster."""
    from scipy.spatial import KDTree

    if len(points) == 0:
        return np.empty(0, np.int64)
    thin = voxels_of(points - box_of(points)[0], _LINK)
    cells = np.floor(thin.means / _LINK)
    return connected_parts(KDTree(cells).query_pairs(1.8, output_type="ndarray"), len(cells))[thin.inverse]
