"""Objects whose top the camera did not fully see, and the objects that hide it: something may rest there unseen.

The camera sees a place if no point of another object lies on the line of sight before it. Places are taken on a
grid over the highest points of an object, a little above them, with a margin around for the part of the top that
is itself out of sight. The table, and points of no object, hide nothing.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.clouds.view_image import ViewImage, lengths

CELL = 0.01
"""Metres between two places; smaller finds smaller hidden parts and costs time with its square."""
TOP = 0.015
"""Metres below an object's highest points that still belong to its top: the noise of a Kinect on a table."""
ABOVE = 0.01
"""Metres above the top at which places are looked at; half the height of a small object."""
BEFORE = 0.02
"""Metres by which a point must lie before a place to hide it; more than the noise of the depth."""
PIXEL = 0.004
"""Radians; above the angle between neighbouring points of a Kinect (0.002), so that a surface has no gaps."""
LEAST_HIDDEN = 6
"""Hidden places (6 cm²) from which a small object could lie there unseen; fewer are noise at edges."""


def hidden_tops(cloud: LabelledCloud) -> dict[int, tuple[int, ...]]:
    """The objects whose top is partly hidden, ascending, each with those that hide it; none without a camera.

    Once these are taken away, fewer than `LEAST_HIDDEN` of the places that are now hidden stay so. A camera below
    a top does not see it at all, but such a position is often a placeholder, as in the header of a cloud that was
    moved to another frame: these tops do not count.

    Parameters
    ----------
    cloud : LabelledCloud
        In the scene frame, z up.
    """
    if cloud.camera is None or not cloud.objects:
        return {}
    is_object = cloud.labels > TABLE
    image = _Image(cloud.points[is_object] - cloud.camera, cloud.labels[is_object])
    places = {label: _places_over(cloud.of(label)) - cloud.camera for label in cloud.objects}
    hiding = {label: image.hiding(rays, label) for label, rays in places.items()}
    return {label: hiders for label, hiders in hiding.items() if hiders}


class _Image(ViewImage):
    """The nearest object in each pixel and its distance, and those of the nearest other object.

    Parameters
    ----------
    rays : (n, 3) float64
        Points from the camera, metres, n ≥ 1.
    labels : (n,) int64
        The object of each.
    """

    def __init__(self, rays: NDArray[np.float64], labels: NDArray[np.int64]) -> None:
        super().__init__(rays, PIXEL)
        self._label = self._owner(self.nearest, labels, np.ones(len(rays), bool))
        other = labels != self._label[self.at]
        self._second = np.full(len(self.nearest), np.inf)
        np.minimum.at(self._second, self.at[other], self.depths[other])
        self._second_label = self._owner(self._second, labels, other)

    def _owner(
        self, nearest: NDArray[np.float64], labels: NDArray[np.int64], which: NDArray[np.bool_]
    ) -> NDArray[np.int64]:
        """The object of the point of `which` that is nearest in each pixel; 0 where there is none."""
        wins = which & (self.depths == nearest[self.at])
        owner = np.zeros(len(nearest), np.int64)
        owner[self.at[wins]] = labels[wins]
        return owner

    def hiding(self, rays: NDArray[np.float64], label: int) -> tuple[int, ...]:
        """The objects that hide places below the camera from it, ascending; rays to the places are ``(m, 3)``.

        Those that hide most, until fewer than `LEAST_HIDDEN` places are left.
        """
        at, inside = self.pixels_of(rays)
        own = self._label[at] == label
        depths = np.where(own, self._second[at], self.nearest[at])
        hidden = inside & (rays[:, 2] < 0) & (depths < lengths(rays) - BEFORE)
        before = np.where(own, self._second_label[at], self._label[at])[hidden]
        hiders, counts = np.unique(before, return_counts=True)
        order = np.argsort(-counts, kind="stable")
        left = np.count_nonzero(hidden) - np.cumsum(counts[order]) + counts[order]
        return tuple(sorted(hiders[order][left >= LEAST_HIDDEN].tolist()))


def _places_over(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Places above an object's top, ``(n, 3)``: filled between its highest points, and one cell around."""
    height = float(np.quantile(points[:, 2], 0.98))
    top = points[points[:, 2] >= height - TOP, :2]
    cells = np.floor(top / CELL).astype(np.int64)
    low = cells.min(axis=0) - 1
    grid = np.zeros(cells.max(axis=0) - low + 2, bool)
    grid[tuple((cells - low).T)] = True
    filled = _between(grid) | _between(grid.T).T
    wide = filled.copy()
    for axis in (0, 1):
        wide |= np.roll(wide, 1, axis) | np.roll(wide, -1, axis)
    places = (np.argwhere(wide) + low + 0.5) * CELL
    return np.column_stack([places, np.full(len(places), height + ABOVE)])


def _between(grid: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cells with a filled cell before and behind them in their row, filled ones included."""
    before = np.maximum.accumulate(grid, axis=1)
    behind = np.maximum.accumulate(grid[:, ::-1], axis=1)[:, ::-1]
    return before & behind
