"""Free space between patches of a surface: places that the camera sees through.

A line between two places of a convex object's surface runs within the object, which hides what is behind it.
Between two objects that touch at a corner, along a ledge or across a gap, the camera sees through much of it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.perception.clouds.view_image import ViewImage

_PIXEL = 0.006
"""Radians; three points of a Kinect, so that a surface has no gaps in it."""
_SEEN = 60_000
"""Points of the image; fewer leave gaps in surfaces."""
_NOISE = 1.5
"""Voxels from a line to what is behind it; less takes noise for free space."""
_STEPS = np.array([0.25, 0.5, 0.75])
"""Where a line is looked at."""


class View(NamedTuple):
    """What the camera sees, as compiled functions take it.

    Parameters
    ----------
    camera : (3,) float64
    nearest, farthest : (columns, rows) float64
        Metres to the nearest and to the farthest point in each pixel; infinite where there is none.
    low : (2,) int64
        Column and row of the first pixel, as of `view_pixels`.
    """

    camera: NDArray[np.float64]
    nearest: NDArray[np.float64]
    farthest: NDArray[np.float64]
    low: NDArray[np.int64]


def view_from(camera: NDArray[np.float64] | None, seen: NDArray[np.float64]) -> View:
    """The view of the points `seen` (n, 3); without a `camera` (3,), one that sees nothing."""
    if camera is None:
        return View(np.zeros(3), np.empty((0, 0)), np.empty((0, 0)), np.zeros(2, np.int64))
    image = ViewImage(seen[:: max(1, len(seen) // _SEEN)] - camera, _PIXEL)
    farthest = np.full(len(image.nearest), -np.inf)
    np.maximum.at(farthest, image.at, image.depths)
    return View(camera, image.nearest.reshape(image.shape), farthest.reshape(image.shape), image.low)


@inlined
def behind(place, view):
    """Metres from a place (3,) back to the nearest and to the farthest that the camera sees in its direction.

    Negative if that hides the place; 0 if nothing is seen there.
    """
    x, y, z = place - view.camera
    across = np.sqrt(x * x + y * y)
    column = int(np.floor(np.arctan2(y, x) / _PIXEL)) - view.low[0]
    row = int(np.floor(np.arctan2(z, across) / _PIXEL)) - view.low[1]
    if 0 <= column < view.nearest.shape[0] and 0 <= row < view.nearest.shape[1]:
        depth = np.sqrt(across * across + z * z)
        if np.isfinite(view.nearest[column, row]):
            return view.nearest[column, row] - depth, view.farthest[column, row] - depth
    return 0.0, 0.0


@kernel
def free_share(first, second, patches, voxel, view):
    """Share of places on the lines between `first` and `second` patches, 0 to 1, that are free.

    Of patches that face each other, as across the inside of a bowl, no place is. `voxel` is the length of the
    surface's voxels, metres.
    """
    free, middles, normals = 0, patches.middles, patches.normals
    for i in first:
        for j in second:
            apart = middles[j] - middles[i]
            if min(normals[i] @ apart, -(normals[j] @ apart)) > voxel:
                continue
            for step in _STEPS:
                free += behind(middles[i] + step * apart, view)[0] > _NOISE * voxel
    return free / (len(first) * len(second) * len(_STEPS))
