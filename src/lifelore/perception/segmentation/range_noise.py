"""Noise of a depth camera by range: the half width of the band that a plane's points fill."""

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.segmentation.plane import NEAR

GROWTH = 0.006
"""Half width of a plane's band in metres at 1 m range; it grows with range², to 24 mm at 2 m. There, 95 % of the
points of a Kinect's table lie within 16 to 25 mm. A larger value takes more of an object's foot for the table."""


def band(points: NDArray[np.floating], camera: NDArray[np.float64] | None) -> NDArray[np.float64]:
    """(n,) metres from a plane within which a point counts as on it: at least `plane.NEAR`, then as range squared.

    A triangulating depth camera's error grows with the square of the range. Without a `camera` (3,) the range is
    unknown, and the band is `plane.NEAR` everywhere.
    """
    return np.maximum(NEAR, noise(points, camera)) if camera is not None else np.full(len(points), NEAR)


def noise(points: NDArray[np.floating], camera: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) metres: half width of the band that the noise alone fills; it has no least width."""
    squares = np.einsum("ij,ij->i", points, points)
    squares -= 2 * (points @ camera) - camera @ camera
    squares *= GROWTH
    return squares
