"""Depth in metres from the numbers of a depth image."""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError

MILLIMETRE = 0.001
"""Metres for each unit of depth in whole numbers: the convention of ROS."""


def metres_of_depth(values: NDArray, depth_scale: float | None = None) -> NDArray[np.floating]:
    """Depth in metres, float32 or float64, NaN where nothing was measured.

    Parameters
    ----------
    values : (height, width) unsigned or signed integers, or floats
    depth_scale : float, optional
        Metres for each unit, > 0. Default: 0.001 for integers, 1 for floats.

    Raises
    ------
    InputError
        A shape, a type or the scale breaks its rule, or nothing was measured.
    """
    if values.ndim != 2 or values.dtype.kind not in "fiu" or values.dtype.itemsize == 1:
        raise InputError(
            f"a depth image must have shape (height, width) and 16-bit whole numbers or floats, got {values.dtype}"
            f" {values.shape}"
        )
    if depth_scale is not None and not (np.isfinite(depth_scale) and depth_scale > 0):
        raise InputError(f"depth_scale must be a positive number of metres for each unit, got {depth_scale}")
    scale = depth_scale or (1.0 if values.dtype.kind == "f" else MILLIMETRE)
    kind = np.float64 if values.dtype.itemsize > 4 or values.dtype == np.int32 else np.float32
    metres = values.astype(kind) * kind(scale)
    measured = np.isfinite(metres) & (metres > 0)
    if not measured.any():
        raise InputError(
            f"holds no measured depth among {metres.size} pixels: all are zero, negative or not finite"
        )
    return np.where(measured, metres, kind(np.nan))
