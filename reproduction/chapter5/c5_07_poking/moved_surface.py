"""`ViewAfter`: whether a place is a surface, empty, or hidden in a picture; evidence for and against a motion."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.registration.tabletop_view import TabletopView
from lifelore.perception.segmentation.surface_voxels import surface_voxels

NEAR = 0.007
"""Metres within which a moved point lies on the surface; about three standard deviations of a Kinect's depth."""
BEHIND = 0.015
"""Metres by which a place must lie before the seen surface to be empty, and behind it to be hidden."""
UNSEEN_COST = 0.35
"""Cost of a hidden place, between 0 of a surface and 1 of an empty place."""
_ANGLE = 0.006
"""Radians between a place's direction and that of the nearest measured point, beyond which nothing is known."""
VOXEL = 0.005
_MOST_VOXELS = 60_000


class ViewAfter:
    """The cloud of a scene after a push.

    Parameters
    ----------
    cloud : LabelledCloud
        With its camera; only the table's label is read.
    """

    def __init__(self, cloud: LabelledCloud) -> None:
        assert cloud.camera is not None
        self._camera = cloud.camera
        rays = cloud.points - cloud.camera
        self._depths = np.linalg.norm(rays, axis=1)
        self._directions = KDTree(rays / self._depths[:, None])
        surface = surface_voxels(cloud.points[cloud.labels != TABLE], cloud.camera, VOXEL, _MOST_VOXELS)
        self.surface = view_of(surface.points, surface.normals)

    def costs(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) cost of surface at places (n, 3): 0 on a surface, 1 if seen to be empty, between if unseen."""
        away = places - self._camera
        distance = np.linalg.norm(away, axis=1)
        apart, nearest = self._directions.query(away / distance[:, None], distance_upper_bound=_ANGLE)
        known = np.isfinite(apart)
        depth = np.where(known, self._depths[np.where(known, nearest, 0)], distance)
        empty = known & (depth > distance + BEHIND)
        gap, _ = self.surface.tree.query(places, distance_upper_bound=2 * NEAR)
        on = gap <= NEAR
        return np.where(on, 0.0, np.where(empty, 1.0, UNSEEN_COST))


def view_of(points: NDArray[np.float64], normals: NDArray[np.float64]) -> TabletopView:
    """A surface (m, 3) with unit normals as registrations read it, without a table."""
    return TabletopView(np.eye(4), points, normals, np.empty((0, 3)))
