"""`upright_box`: the smallest box around an object's visible points that stands upright."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.cloud_origin import CloudOrigin
from lifelore.perception.segmentation.outline import convex_corners


class ObjectBox(NamedTuple):
    """A box in space.

    centre : (3,) metres; axes : (3, 3), rows are unit vectors and a right-handed system; size : (3,), metres along
    each axis, ≥ 0
    """

    centre: NDArray[np.float64]
    axes: NDArray[np.float64]
    size: NDArray[np.float64]

    def in_camera(self, origin: CloudOrigin) -> "ObjectBox":
        """The same box in the camera's frame."""
        return ObjectBox(origin.in_camera(self.centre), origin.turned_to_camera(self.axes), self.size)


def upright_box(points: NDArray[np.float64]) -> ObjectBox:
    """The box of least footprint around points, its third axis the scene's z.

    A rectangle of least area has a side along an edge of the convex hull, so each edge is tried (Freeman and
    Shapira, 1975). The first axis is along the longer side and points to x ≥ 0. The box holds every point given;
    of an object that is hidden in part, it is smaller than the object.

    Parameters
    ----------
    points : (n, 3) float64
        n ≥ 1, metres, z up.
    """
    corners = _hull(np.ascontiguousarray(points[:, :2]))
    along = np.diff(corners, axis=0, append=corners[:1])
    length = np.hypot(*along.T)
    along = along[length > 0] / length[length > 0, None] if (length > 0).any() else np.eye(2)[:1]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    sides = np.stack([np.ptp(corners @ along.T, axis=0), np.ptp(corners @ across.T, axis=0)], axis=1)
    best = int(np.argmin(sides.prod(axis=1)))
    x = along[best] if sides[best, 0] >= sides[best, 1] else across[best]
    x = -x if x[0] < 0 else x
    axes = np.array([[x[0], x[1], 0.0], [-x[1], x[0], 0.0], [0.0, 0.0, 1.0]])
    within = corners @ axes[:2, :2].T
    low = np.append(within.min(axis=0), points[:, 2].min())
    high = np.append(within.max(axis=0), points[:, 2].max())
    return ObjectBox((low + high) / 2 @ axes, axes, high - low)


def _hull(flat: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, 2) corners of the convex hull, in turn; the two ends of points on a line."""
    corners = convex_corners(flat)
    return flat[np.lexsort(flat.T[::-1])[[0, -1]]] if corners is None else corners
