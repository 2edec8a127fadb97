"""Pixels of lines of sight: directions in cells of equal angle, an image of clouds without a grid too."""

import numpy as np
from numpy.typing import NDArray


def view_pixels(rays: NDArray[np.float64], size: float) -> NDArray[np.int64]:
    """(n, 2) column and row of the pixel of each ray (n, 3), `size` radians wide and high; rows ascend upwards."""
    turn = np.arctan2(rays[:, 1], rays[:, 0])
    rise = np.arctan2(rays[:, 2], np.hypot(rays[:, 0], rays[:, 1]))
    return np.floor(np.column_stack([turn, rise]) / size).astype(np.int64)


class ViewImage:
    """The distance of the nearest point in each pixel of a view, metres.

    Parameters
    ----------
    rays : (n, 3) float64
        Points from the camera, n ≥ 1.
    size : float
        Side of a pixel, radians.

    Attributes
    ----------
    shape : (columns, rows)
    at, depths : (n,)
        Number of the pixel of each point, column by column, and its distance.
    nearest : (columns · rows,) float64
        Infinite in a pixel without a point.
    """

    def __init__(self, rays: NDArray[np.float64], size: float) -> None:
        pixels = view_pixels(rays, size)
        self._size, self._low = size, pixels.min(axis=0)
        columns, rows = (pixels.max(axis=0) - self._low + 1).tolist()
        self.shape = columns, rows
        self.at = (pixels[:, 0] - self._low[0]) * rows + pixels[:, 1] - self._low[1]
        self.depths = lengths(rays)
        self.nearest = np.full(columns * rows, np.inf)
        np.minimum.at(self.nearest, self.at, self.depths)

    def pixels_of(self, rays: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Number of the pixel of each ray (m, 3), 0 outside the image, and whether it is inside; (m,) each."""
        pixels = view_pixels(rays, self._size) - self._low
        inside = ((pixels >= 0) & (pixels < self.shape)).all(axis=1)
        return np.where(inside, pixels[:, 0] * self.shape[1] + pixels[:, 1], 0), inside


def rays_beside(rays: NDArray[np.float64], directions: NDArray[np.float64], margin: float) -> NDArray[np.bool_]:
    """(n,) bool: which of rays (n, 3) lie in a cone around unit vectors (k, 3), with `margin` radians to spare."""
    middle = directions.mean(axis=0)
    middle /= max(float(np.linalg.norm(middle)), 1e-9)
    return rays @ middle >= ((directions @ middle).min() - margin) * lengths(rays)


def lengths(rays: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) lengths of rays (n, 3)."""
    return np.sqrt(np.einsum("ij,ij->i", rays, rays))
