"""`TabletopView`: one view upright on its table, as far as registration needs it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.clouds.voxel import thinned, voxels_of
from lifelore.perception.segmentation.plane import Plane
from lifelore.perception.segmentation.range_noise import band
from lifelore.perception.segmentation.region import over_table
from lifelore.perception.segmentation.surface_voxels import surface_voxels
from lifelore.perception.segmentation.table_frame import Up, table_plane, up_direction, upright
from lifelore.perception.segmentation.table_search import find_table

OBJECT_VOXEL, TABLE_VOXEL = 0.005, 0.01
"""Metres; smaller voxels make registration slower, not more precise: the sensor's noise is 1 to 5 mm."""
BORDER = 0.15
"""Metres around the objects within which the table's points are used."""
_MOST_VOXELS = 12_000
_FEWEST = 30
"""An area of objects of fewer voxels is noise on a bare table."""


@dataclass(frozen=True, eq=False)
class TabletopView:
    """A view with z = 0 at its table and the middle of its objects at x = y = 0.

    Parameters
    ----------
    from_view : (4, 4) float64
        From the frame of the cloud to this frame.
    objects, normals : (m, 3) float64
        Voxels of what stands on the table; unit normals towards the camera.
    table : (k, 3) float64
        Voxels of the table's surface near the objects.
    """

    from_view: NDArray[np.float64]
    objects: NDArray[np.float64]
    normals: NDArray[np.float64]
    table: NDArray[np.float64]

    @cached_property
    def surface(self) -> NDArray[np.float64]:
        """(m + k, 3): all voxels, the objects' first."""
        return np.concatenate([self.objects, self.table])

    @cached_property
    def surface_normals(self) -> NDArray[np.float64]:
        """(m + k, 3): normals of `surface`."""
        return np.concatenate([self.normals, np.tile([0.0, 0.0, 1.0], (len(self.table), 1))])

    @cached_property
    def tree(self) -> KDTree:
        """Search tree of `surface`."""
        return KDTree(self.surface)


def tabletop_view(cloud: PointCloud, up: Up = "table") -> TabletopView:
    """A cloud upright on its table.

    Labels name the table and the objects where there are any; else the table is searched for, and objects are what
    stands over it.

    Raises
    ------
    InputError
        No table is found, or nothing stands on it.
    """
    cloud = thinned(cloud)
    cloud = cloud.only(cloud.measured)
    points = cloud.points.astype(np.float64)
    plane, on_it, over = _parts(points, cloud, up)
    rotation = upright(plane.normal)
    standing = points @ rotation.T + [0.0, 0.0, plane.offset]
    if np.count_nonzero(over) < _FEWEST:
        raise InputError("nothing stands on the table, so that there is nothing to register by")
    low, high = standing[over].min(axis=0), standing[over].max(axis=0)
    shift = np.array([-(low[0] + high[0]) / 2, -(low[1] + high[1]) / 2, plane.offset])
    from_view = np.eye(4)
    from_view[:3, :3], from_view[:3, 3] = rotation, shift
    camera = None if cloud.camera is None else rotation @ cloud.camera + shift
    objects = surface_voxels(points[over] @ rotation.T + shift, camera, OBJECT_VOXEL, _MOST_VOXELS)
    near = (
        on_it
        & (standing[:, :2] > low[:2] - BORDER).all(axis=1)
        & (standing[:, :2] < high[:2] + BORDER).all(axis=1)
    )
    table = voxels_of(points[near] @ rotation.T + shift, TABLE_VOXEL).means
    return TabletopView(from_view, objects.points, objects.normals, table)


def _parts(
    points: NDArray[np.float64], cloud: PointCloud, up: Up
) -> tuple[Plane, NDArray[np.bool_], NDArray[np.bool_]]:
    """The table's plane, and which points are the table's and the objects'."""
    if cloud.labels is not None and cloud.is_labelled:
        plane = table_plane(cloud)
        return plane, cloud.labels == TABLE, cloud.labels > TABLE
    table = find_table(points, cloud.camera, up_direction(up)).table
    if table is None:
        raise InputError("no table was found, on which the views could be laid over each other")
    return table.plane, *over_table(points, band(points, cloud.camera), table)
