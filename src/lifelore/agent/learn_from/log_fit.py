"""Compares the poses of a log with the map, and finds the offset that lays a log in another frame on it.

A pose lies outside if it is farther than `TOLERANCE` from every point at which the robot's centre can be. These
points keep the robot's radius from walls, so that only larger noise puts a pose of a good log outside.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, signal

from lifelore.agent.learn_from.run_log import Run
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.free_space import free_pixels
from lifelore.domains.buildings.inflation import inflate
from lifelore.domains.buildings.registration import Pose, moved

Shift = Pose
"""x, y in metres and yaw in radians: p becomes R(yaw)·p + (x, y)."""
TOLERANCE = 0.15
"""Metres: three standard deviations of a localisation with 5 cm."""
MOST_OUTSIDE, MENDED = 0.02, 0.005
"""Share of poses outside from which a log is refused, and below which an offset mends it."""
FARTHEST_SHIFT = 10.0
"""Metres that are searched for an offset."""
TURNS = [np.deg2rad(turns).tolist() for turns in ((0,), range(-5, 6), (90, -90, 180))]
"""Turns in radians that are searched, the later ones where the earlier ones mend nothing."""
SURE = 0.5
"""Metres: the largest distance between two offsets that mend a log equally, half of it the error of the answer."""
SURE_TURN = np.deg2rad(6)
"""Radians: the same for turns."""
_PIXEL, _POSES, _MOST_CANDIDATES = 0.1, 2000, 5000
"""Metres a pixel of the search, number of poses that it compares, and number of offsets that are too many."""


@dataclass(frozen=True, eq=False)
class Reachable:
    """Where a robot's poses can lie.

    floor : the building's pixels
    near : (rows, columns) bool, pixels within `TOLERANCE` of a point at which the robot's centre can be
    """

    floor: Floor
    near: NDArray[np.bool_]

    @classmethod
    def of(cls, floor: Floor) -> "Reachable":
        """The free space that hangs together with the places of a floor; also its niches that are no places."""
        free = free_pixels(floor.occupancy, floor.solid, floor.robot_radius)
        label = np.asarray(ndimage.label(free, np.ones((3, 3)))[0])  # type: ignore[index]
        joined = free & np.isin(label, np.unique(label[floor.state >= 0]))
        return cls(floor, inflate(joined, TOLERANCE / floor.occupancy.resolution + 1))

    def outside(self, points: NDArray[np.float64]) -> NDArray[np.bool_]:
        """(n,) whether points (n, 2), in metres of the map's frame, lie outside."""
        at = np.rint(self.floor.pixels(points)).astype(np.int64)
        inside = ((at >= 0) & (at < self.near.shape)).all(axis=1)
        outside = np.ones(len(at), bool)
        outside[inside] = ~self.near[tuple(at[inside].T)]
        return outside


def mending_shift(points: NDArray[np.float64], reachable: Reachable) -> tuple[Shift, float] | None:
    """The offset that lays all but `MENDED` of the poses inside, and that share; None if none does, or several do.

    Parameters
    ----------
    points : (n, 2) float
        Metres of the log's frame.
    reachable : Reachable
    """
    occupancy = reachable.floor.occupancy
    if np.ptp(points, axis=0).max() > np.hypot(*occupancy.state.shape) * occupancy.resolution:
        return None  # no turn lays poses that are farther apart than the corners of the map
    points = points[np.linspace(0, len(points) - 1, min(_POSES, len(points))).astype(int)]
    for turns in TURNS:
        candidates = [shift for turn in turns for shift in _candidates(points, turn, reachable)]
        if len(candidates) > _MOST_CANDIDATES:
            return None
        share = np.array([reachable.outside(moved(shift, points)).mean() for shift in candidates])
        if (share <= MENDED).any():
            return _middle(points, np.array(candidates)[share <= MENDED], reachable)
    return None


def _middle(
    points: NDArray[np.float64], good: NDArray[np.float64], reachable: Reachable
) -> tuple[Shift, float] | None:
    """The middle of the offsets (n, 3) that mend a log, and its share of poses outside; None if they differ."""
    # Where the middle of the log comes to lie, because a turn about the origin moves it.
    middles = np.array([moved(tuple(one), points.mean(axis=0)[None])[0] for one in good])
    if np.ptp(middles, axis=0).max() > SURE or np.ptp(good[:, 2]) > SURE_TURN:
        return None
    apart = np.hypot(*(middles - middles.mean(axis=0)).T) + np.abs(good[:, 2] - good[:, 2].mean())
    best = good[apart.argmin()]
    x, y, yaw = round(float(best[0]), 2), round(float(best[1]), 2), round(float(best[2]), 4)
    share = float(reachable.outside(moved((x, y, yaw), points)).mean())
    return ((x, y, yaw), share) if share <= 2 * MENDED else None


def _candidates(points: NDArray[np.float64], turn: float, reachable: Reachable) -> list[Shift]:
    """Shifts with this turn about the middle of the log that lay most poses inside, on coarse pixels.

    The number of poses inside, for all shifts, is the correlation of the poses' picture with the free space.
    """
    floor = reachable.floor
    step = max(1, round(_PIXEL / floor.occupancy.resolution))
    side, free = step * floor.occupancy.resolution, reachable.near[::step, ::step]
    middle = points.mean(axis=0)
    turned = moved((0.0, 0.0, turn), points - middle) + middle
    at = np.rint(floor.pixels(turned) / step).astype(np.int64)
    low, reach = at.min(axis=0), round(FARTHEST_SHIFT / side)
    picture = np.zeros(at.max(axis=0) - low + 1)
    np.add.at(picture, tuple((at - low).T), 1.0)
    # The part of the free space that the picture can come to cover, with nothing free beyond the map.
    window = np.zeros(np.array(picture.shape) + 2 * reach)
    first = low - reach
    inside = [
        slice(max(f, 0), max(min(f + w, n), 0)) for f, w, n in zip(first, window.shape, free.shape, strict=True)
    ]
    there = [slice(one.start - f, max(one.stop, one.start) - f) for one, f in zip(inside, first, strict=True)]
    window[tuple(there)] = free[tuple(inside)]
    hits = signal.fftconvolve(window, picture[::-1, ::-1], mode="valid")
    rows, columns = np.nonzero(hits >= (1 - MOST_OUTSIDE) * len(points) - 0.5)
    up, right = (reach - rows) * side, (columns - reach) * side
    shifts = moved((0.0, 0.0, floor.occupancy.origin[2]), np.column_stack([right, up]))
    origin = middle - moved((0.0, 0.0, turn), middle[None])[0]
    return [(float(x), float(y), turn) for x, y in shifts + origin]


def shifted_runs(runs: Sequence[Run], shift: Shift) -> list[Run]:
    """Runs after a shift."""
    return [replace(run, points=moved(shift, run.points), heading=run.heading + shift[2]) for run in runs]
