"""Resamples an occupancy map on the grid of an earlier map of the same building, so that their cells coincide."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.buildings.occupancy_map import UNKNOWN, OccupancyMap
from lifelore.domains.buildings.registration import IDENTITY, Pose, composed, inverse, moved
from lifelore.domains.grids.grid_world import Frame

_ROWS = 512
"""Rows that are computed at a time; more need more memory."""
_RAGGED = 2
"""Pixels that may lie beyond the earlier map's picture without making the grid larger."""


@dataclass(frozen=True)
class MapFrame:
    """Where the first map of a building lies in its own world frame.

    origin : pose of the lower left corner of its picture
    size : width and height of its picture in metres
    """

    origin: Pose
    size: tuple[float, float]

    @classmethod
    def of(cls, occupancy: OccupancyMap) -> "MapFrame":
        """The frame of a building's first map."""
        rows, columns = occupancy.state.shape
        return cls(occupancy.origin, (columns * occupancy.resolution, rows * occupancy.resolution))


def aligned_map(
    new: OccupancyMap, pose: Pose, frame: MapFrame, cell: float, pixel: float | None = None
) -> tuple[OccupancyMap, tuple[int, int]]:
    """A map with its pixels on the grid of an earlier map, and the cell of its lower left corner.

    Parameters
    ----------
    new : OccupancyMap
    pose : (dx, dy, dyaw)
        From the world frame of `new` to the world frame of the earlier map.
    frame : MapFrame
        Of the earlier map.
    cell : float
        Side of a cell in metres. The picture covers that of the earlier map; it grows by whole cells where `new`
        knows more.
    pixel : float, optional
        Side of a pixel of the result in metres; default: that of `new`.

    Returns
    -------
    aligned : OccupancyMap
        Each pixel has the state of the pixel of `new` in which its centre lies. The origin is in the world frame
        of `new`, so positions in metres stay those of `new`.
    corner : (row, column)
        Cell of the lower left corner, counted from the lower left corner of the earlier map; at most 0.
    """
    pixel = new.resolution if pixel is None else pixel
    if pose == IDENTITY and MapFrame.of(new) == frame and pixel == new.resolution:
        return new, (0, 0)
    to_frame = composed(
        inverse(frame.origin), composed(pose, new.origin)
    )  # picture of `new` → picture of the frame
    low, high = _extent(new, to_frame)
    slack = _RAGGED * max(pixel, new.resolution)
    corner, shape = [], []
    for axis in (0, 1):
        first = 0 if low[axis] >= -slack else int(np.floor(low[axis] / cell))
        end = frame.size[axis] if high[axis] <= frame.size[axis] + slack else np.ceil(high[axis] / cell) * cell
        corner.append(first)
        shape.append(round((end - first * cell) / pixel))
    here = composed(inverse(pose), frame.origin)
    origin = composed(here, (corner[0] * cell, corner[1] * cell, 0.0))
    if pose == IDENTITY and corner == [0, 0]:
        origin = frame.origin  # without rounding, so that the same world has the same fingerprint
    state = resampled(new, new.state, UNKNOWN, Frame(pixel, origin), (shape[1], shape[0]))
    return OccupancyMap(state, pixel, origin, new.source), (corner[1], corner[0])


def axis_aligned(occupancy: OccupancyMap) -> OccupancyMap:
    """The map itself if its yaw is 0, else its pixels resampled on a grid along x and y, in the same frame.

    The copy covers the whole picture; each pixel has the state of the pixel in which its centre lies, unknown
    outside the picture.
    """
    if occupancy.origin[2] == 0:
        return occupancy
    pixel, frame = occupancy.resolution, MapFrame.of(occupancy)
    corners = moved(frame.origin, np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]) * frame.size)
    low, high = corners.min(axis=0), corners.max(axis=0)
    columns, rows = np.ceil((high - low) / pixel - 1e-9).astype(int).tolist()
    origin = (float(low[0]), float(low[1]), 0.0)
    state = resampled(occupancy, occupancy.state, UNKNOWN, Frame(pixel, origin), (rows, columns))
    return OccupancyMap(state, pixel, origin, occupancy.source)


def resampled(
    occupancy: OccupancyMap, values: NDArray[np.uint8], outside: int, frame: Frame, shape: tuple[int, int]
) -> NDArray[np.uint8]:
    """Values of the pixels of a map at the pixel centres of a picture of this frame and shape.

    `outside` stands where the map has no pixel.
    """
    found, columns = np.empty(shape, np.uint8), np.arange(shape[1]) + 0.5
    for top in range(0, shape[0], _ROWS):
        up = shape[0] - 0.5 - np.arange(top, min(top + _ROWS, shape[0]))
        right, above = np.meshgrid(columns, up)
        part = occupancy.values_at(frame.metres(right.ravel(), above.ravel()), values, outside)
        found[top : top + _ROWS] = part.reshape(right.shape)
    return found


def _extent(new: OccupancyMap, to_frame: Pose) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Smallest and largest x and y of the known pixels in the frame of the earlier picture."""
    known = new.state != UNKNOWN
    row = np.flatnonzero(known.any(axis=1))
    if not row.size:
        return np.zeros(2), np.zeros(2)
    # The first and the last pixel of each row contain every extreme point.
    first, last = known[row].argmax(axis=1), known.shape[1] - 1 - known[row, ::-1].argmax(axis=1)
    column, row = np.concatenate([first, last]), np.concatenate([row, row])
    centres = moved(to_frame, np.column_stack([column + 0.5, len(known) - row - 0.5]) * new.resolution)
    half = new.resolution / 2
    return centres.min(axis=0) - half, centres.max(axis=0) + half
