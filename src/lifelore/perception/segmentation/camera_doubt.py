"""Doubt about the camera of a cloud: whether the points can have been seen from its position.

A camera sees one surface on a line of sight. A cloud that was moved to another frame, such as a robot's, while its
camera stayed at the origin, has surfaces behind others all over. On 36 clouds of a Kinect, 0 to 0.8 % of the
points lie behind others from the true camera, and from most wrong ones 3 to 40 %.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.clouds.voxel import voxels_of

CELL = 0.004
"""Unit vectors: side of a cell of directions; twice the angle between neighbouring points of a Kinect."""
BEHIND = 0.05
"""Metres behind the nearest point of a cell, at 1 m; it grows with range squared, like a depth camera's error."""
MOST_BEHIND = 0.02
"""Share of points that may lie behind others: edges of objects, and noise."""
NEAREST = 0.15
"""Metres: depth cameras see nothing nearer."""
_MOST_NEAR = 0.01
_FIELD, _IN_FIELD = 1.2, 0.99
"""Tangent of half the widest field of view, and the share of the points within it."""
_ONE_IN = 8
"""One column of cells of so many, a power of two, is looked at; more is faster, and less sure on small clouds."""


def camera_doubt(points: NDArray[np.float64], camera: NDArray[np.float64]) -> str | None:
    """Why the points (n, 3) cannot have been seen from `camera` (3,), both in metres; None without a doubt."""
    rays = np.subtract(points.T, camera[:, None], dtype=np.float32, casting="same_kind", order="C").T
    x, y, z = rays.T
    ranges = np.sqrt(x * x + y * y + z * z)
    near = float(np.mean(ranges < NEAREST))
    # A scene that is near as a whole may be in other units.
    if _MOST_NEAR < near < 0.5:
        return f"{100 * near:.0f} % of the points lie within {100 * NEAREST:.0f} cm of it"
    share = share_behind(rays, ranges)
    return f"{100 * share:.0f} % of the points would lie behind others" if share > MOST_BEHIND else None


def is_camera_frame(points: NDArray[np.float64]) -> bool:
    """Whether points (n, 3) may be in the frame of a camera, z forward: nearly all lie in its field of view."""
    x, y, z = points.T
    return float(np.mean((z > 0) & (np.abs(x) < _FIELD * z) & (np.abs(y) < _FIELD * z))) >= _IN_FIELD


def camera_at_origin(points: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """The origin, (3,), where points (n, 3) of an unknown camera may have been seen from there; else None.

    Depth cameras write points in their own frame, and many files do not say so.
    """
    camera = np.zeros(3)
    return camera if is_camera_frame(points) and camera_doubt(points, camera) is None else None


def share_behind(rays: NDArray[np.float32], ranges: NDArray[np.float32]) -> float:
    """Share of the points that lie behind another one by more than `BEHIND`; rays (n, 3) lead from the camera."""
    size = CELL * np.maximum(ranges, 1e-6)
    column = np.floor(rays[:, 0] / size).astype(np.int32)
    chosen = np.flatnonzero(column & (_ONE_IN - 1) == 0)
    if not len(chosen):
        return 0.0
    depths = ranges[chosen].astype(np.float64)
    cell, first, *_ = voxels_of(rays[chosen] / np.maximum(depths, 1e-6)[:, None], CELL)
    nearest = np.full(len(first), np.inf)
    np.minimum.at(nearest, cell, depths)
    nearest = nearest[cell]
    return float(np.mean(depths > nearest + BEHIND * np.maximum(nearest, 1.0) ** 2))
