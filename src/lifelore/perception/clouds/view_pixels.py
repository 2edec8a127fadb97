"""Pixels of lines of sight: directions in cells of equal angle, an image of clouds without a grid too."""

import numpy as np
from numpy.typing import NDArray


def view_pixels(rays: NDArray[np.float64], size: float) -> NDArray[np.int64]:
    """(n, 2) column and row of the pixel of each ray (n, 3), `size` radians wide and high; rows ascend upwards."""
    turn = np.arctan2(rays[:, 1], rays[:, 0])
    rise = np.arctan2(rays[:, 2], np.hypot(rays[:, 0], rays[:, 1]))
    return np.floor(np.column_stack([turn, rise]) / size).astype(np.int64)
