"""Obstacles grown by a robot's radius, so that the robot may be planned for as a point.

As in ROS costmaps, distances run from pixel centre to pixel centre: a pixel is blocked when the centre of
an occupied pixel lies within the radius. What counts as occupied is the
caller's to say.
"""

import math

import numpy as np
from numpy.typing import NDArray

_TOLERANCE = 1e-9  # three pixels of 0.1 m lie within a radius of 0.3 m, whatever the floats say


def inflate(occupied: NDArray[np.bool_], radius: float) -> NDArray[np.bool_]:
    """Every pixel whose centre is within `radius` of an occupied pixel's centre.

    Parameters
    ----------
    occupied : (rows, columns) bool
    radius : float
        In pixels, at least 0, finite; 0 leaves the obstacles as they are.

    Returns
    -------
    blocked : (rows, columns) bool
        Contains `occupied`.
    """
    # Beyond the picture's diagonal a larger radius blocks no more.
    limit = int((min(radius, math.hypot(*occupied.shape)) * (1 + _TOLERANCE)) ** 2)
    reach = math.isqrt(limit)
    rows_away = _rows_to_obstacle(occupied, reach)
    blocked = np.zeros_like(occupied)
    sideways = min(reach, occupied.shape[1] - 1)
    for shift in range(-sideways, sideways + 1):
        height = math.isqrt(limit - shift * shift)
        near = rows_away <= height
        if shift < 0:
            blocked[:, :shift] |= near[:, -shift:]
        else:
            blocked[:, shift:] |= near[:, : near.shape[1] - shift]
    return blocked


def _rows_to_obstacle(occupied: NDArray[np.bool_], reach: int) -> NDArray:
    """Rows from each pixel to the nearest occupied one of its column; reach + 1 where none is that near."""
    dtype = np.uint8 if reach < 127 else np.uint32
    away = np.where(occupied, 0, reach + 1).astype(dtype)
    step = 1  # Sums of its values, 1, 2, 4 …, are all distances up to `reach`.
    while step <= min(reach, len(away) - 1):
        np.minimum(away[step:], away[:-step] + dtype(step), out=away[step:])
        np.minimum(away[:-step], away[step:] + dtype(step), out=away[:-step])
        step *= 2
    return away
