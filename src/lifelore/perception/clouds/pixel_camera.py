"""The position of a camera from an organised cloud in any frame: the lines of sight of all pixels meet there.

A pinhole camera maps the places X of a frame to pixels (u, v) by a 3 × 4 matrix P: (u, v, 1) ~ P (X, 1). Each
pixel gives two equations that are linear in P, and the camera's place is what P maps to zero (Hartley and
Zisserman 2004, §7.1). Errors of the depth move a point along its own line of sight, so they do not matter.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.clouds.point_cloud import PointCloud

OFF_PIXEL = 1.0
"""Pixels, root mean square: more between the pixels and what P gives means no pinhole camera, as of a lidar."""
FLAT = 1e-4
"""Least share of the second smallest of the largest singular value; less means points of one plane, which tell
little about the camera."""
_MOST = 4000
"""Points that are used."""
_FEW = 100


def camera_from_pixels(cloud: PointCloud) -> NDArray[np.float64] | None:
    """The position of the camera of an organised cloud, (3,) in metres in the frame of its points.

    None for a cloud without a grid, with few points, of a single plane, or not of a pinhole camera.

    Examples
    --------
    >>> from lifelore.perception.clouds.camera_intrinsics import CameraIntrinsics
    >>> depth = np.where(np.arange(48)[:, None] < 24, 1.0, 0.8) + 0.002 * np.arange(64)
    >>> seen = PointCloud.from_depth(depth, CameraIntrinsics(64, 48, 60.0, 60.0, 31.5, 23.5))
    >>> moved = PointCloud(seen.points + [1.0, 2.0, 3.0], grid=seen.grid)
    >>> camera_from_pixels(moved).round(6).tolist()
    [1.0, 2.0, 3.0]
    """
    rows = np.flatnonzero(cloud.measured)
    if cloud.grid is None or len(rows) < _FEW:
        return None
    rows = rows[:: max(1, len(rows) // _MOST)]
    places = cloud.points[rows].astype(np.float64)
    pixel = rows if cloud.source_rows is None else cloud.source_rows[rows]
    if pixel.min() < 0:
        return None  # means of several points
    v, u = np.divmod(pixel, cloud.grid[1])
    shift, scale = places.mean(axis=0), float(places.std())
    x = np.column_stack([(places - shift) / max(scale, 1e-9), np.ones(len(places))])
    centre, width = np.array(cloud.grid[::-1]) / 2, float(max(cloud.grid)) / 2
    u, v = (np.column_stack([u, v]) - centre).T / width
    nothing = np.zeros_like(x)
    equations = np.concatenate(
        [np.hstack([x, nothing, -u[:, None] * x]), np.hstack([nothing, x, -v[:, None] * x])]
    )
    _, sizes, directions = np.linalg.svd(equations, full_matrices=False)
    matrix = directions[-1].reshape(3, 4)
    if sizes[-2] < FLAT * sizes[0]:
        return None
    image = x @ matrix.T
    with np.errstate(divide="ignore", invalid="ignore"):
        off = image[:, :2] / image[:, 2:] - np.column_stack([u, v])
    if not np.sqrt((off**2).sum(axis=1).mean()) * width <= OFF_PIXEL:
        return None
    *at, share = np.linalg.svd(matrix)[2][-1]
    return None if abs(share) < 1e-9 else np.array(at) / share * scale + shift
