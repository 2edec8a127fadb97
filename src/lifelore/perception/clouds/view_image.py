"""Pixels of lines of sight: directions in cells of equal angle, an image of clouds without a grid too."""

import numpy as np
from numpy.typing import NDArray


def view_pixels(rays: NDArray[np.float64], size: float) -> NDArray[np.int64]:
    """(2, n) column and row of the pixel of each ray (n, 3), `size` radians wide and high; rows ascend upwards."""
    x, y, z = rays.T
    angles = np.stack([np.arctan2(y, x), np.arctan2(z, np.sqrt(x * x + y * y))])
    return np.floor(angles / size).astype(np.int64)


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
    low : (2,) int64
        Column and row of the first pixel, as of `view_pixels`.
    at, depths : (n,)
        Number of the pixel of each point, column by column, and its distance.
    nearest : (columns · rows,) float64
        Infinite in a pixel without a point.
    """

    def __init__(self, rays: NDArray[np.float64], size: float) -> None:
        pixels = view_pixels(rays, size)
        self._size, self.low = size, pixels.min(axis=1)
        pixels -= self.low[:, None]
        columns, rows = (pixels.max(axis=1) + 1).tolist()
        self.shape = columns, rows
        self.at = pixels[0] * rows + pixels[1]
        self.depths = lengths(rays)
        self.nearest = np.full(columns * rows, np.inf)
        np.minimum.at(self.nearest, self.at, self.depths)

    def pixels_of(self, rays: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Number of the pixel of each ray (m, 3), 0 outside the image, and whether it is inside; (m,) each."""
        columns, rows = view_pixels(rays, self._size) - self.low[:, None]
        inside = (columns >= 0) & (columns < self.shape[0]) & (rows >= 0) & (rows < self.shape[1])
        return np.where(inside, columns * self.shape[1] + rows, 0), inside


def lengths(rays: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) lengths of rays (n, 3)."""
    return np.sqrt(np.einsum("ij,ij->i", rays, rays))
