"""A building's own map as the ground of a picture, in metres of the map's frame."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.figures.lives.floor_plan import SOLID

if TYPE_CHECKING:
    from matplotlib.axes import Axes

UNKNOWN_GREY = 205
"""Grey of unknown pixels, as `map_saver` writes them; rows and columns without other pixels are cut off."""
MARGIN = 0.3
"""Metres around the known part of the map."""


@dataclass(frozen=True, eq=False)
class MapPlan:
    """The picture of a map, and where it lies.

    Parameters
    ----------
    grey : (rows, columns) uint8
        As `map_saver` draws it: free 254, occupied 0, unknown 205; row 0 is at the top.
    resolution : float
        Metres a pixel.
    origin : (x, y, yaw)
        Pose of the lower left corner of the lower left pixel, metres and radians.
    """

    grey: NDArray[np.uint8]
    resolution: float
    origin: tuple[float, float, float]

    lane = 0.0
    """Ways are drawn where they lead; they do not move aside for each other."""

    @property
    def limits(self) -> NDArray[np.float64]:
        """Least and largest x and y of the known part of the map, (2, 2) metres."""
        rows, columns = np.nonzero(self.grey != UNKNOWN_GREY)
        if not len(rows):
            rows, columns = np.array([0, self.grey.shape[0] - 1]), np.array([0, self.grey.shape[1] - 1])
        right = np.array([columns.min(), columns.max() + 1]) * self.resolution
        up = (self.grey.shape[0] - np.array([rows.max() + 1, rows.min()])) * self.resolution
        x0, y0, yaw = self.origin
        corners = np.array([[x, y] for x in right for y in up])
        turn = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
        placed = corners @ turn + (x0, y0)
        return np.array([placed.min(axis=0) - MARGIN, placed.max(axis=0) + MARGIN])

    @property
    def size(self) -> tuple[float, float]:
        """Height and width, metres."""
        width, height = np.ptp(self.limits, axis=0)
        return float(height), float(width)

    def placed(self, points: ArrayLike) -> NDArray[np.float64]:
        """Where points in metres of the map's frame are drawn, (n, 2)."""
        return np.asarray(points, float).reshape(-1, 2)

    def draw(self, axes: "Axes") -> None:
        """Draw the map, with its metres at the edges."""
        from matplotlib.transforms import Affine2D

        rows, columns = self.grey.shape
        x0, y0, yaw = self.origin
        extent = (0, columns * self.resolution, 0, rows * self.resolution)
        turned = Affine2D().rotate(yaw).translate(x0, y0) + axes.transData
        axes.imshow(self.grey, cmap="gray", vmin=0, vmax=255, extent=extent, transform=turned, zorder=0)
        (left, bottom), (right, top) = self.limits
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", xlabel="x, metres", ylabel="y, metres")
        axes.set_facecolor(SOLID)
