"""Finds the rigid motion that lays one occupancy map on another, and how well the two then agree.

1. All rotations in steps of 1°, and all translations at once: the walls of one map are correlated by FFT with the
   blurred walls of the other (correlative matching; Olson 2009, Carpin 2008).
2. The best poses that differ are searched again in fine steps, then refined below a pixel by robust least squares
   on the distance to the nearest wall (Fitzgibbon 2003).
3. The share of walls that lie on walls, counted both ways where both maps know the ground, judges each pose. A
   second pose that fits nearly as well makes the result ambiguous.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import fft, ndimage, sparse
from scipy.optimize import least_squares
from scipy.sparse import csgraph

from lifelore.domains.buildings.inflation import inflate
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, UNKNOWN, OccupancyMap

Pose = tuple[float, float, float]
"""dx, dy in metres and dyaw in radians: p ↦ R(dyaw) p + (dx, dy)."""
IDENTITY: Pose = (0.0, 0.0, 0.0)

LEAST_WALLED = 0.1
"""Share of the border of free ground that is walls; two maps that both have less are compared by all of it."""
WALL_TOLERANCE = 0.15
"""Metres within which two walls are the same wall."""
SPECK = 3
"""Largest number of adjacent wall pixels without a counterpart that count as noise."""
COARSE_SIDE = 200
"""Largest side of the coarse pictures in pixels; more needs more time and finds smaller overlaps."""
COARSE_PIXEL = 0.3
"""Smallest coarse pixel in metres."""
COARSE_STEP = np.radians(1.0)
N_PEAKS, N_COARSE, N_FINE = 4, 32, 8
"""Poses that stay of each angle, after the coarse search, and after the fine one."""
FINE_REACH, FINE_BLUR = 0.4, 0.2
"""Metres: how far the fine search shifts a coarse pose, and the width of a wall's likelihood."""
FINE_TURNS = np.radians(np.arange(-0.75, 0.76, 0.25))
MOST_BEHIND, LEAST_ROUGH = 0.3, 0.5
"""Rough matches: how far behind the best one a pose is still refined, and from which on maps are as they lie."""
FAR, TURNED = 1.0, np.radians(5.0)
"""Metres at the middle of the map, or radians, from which on two poses are different."""
LEAST_OVERLAP = 0.5
"""Least share of the smaller map's walls that must lie where the other map knows the ground."""
_MOST_POINTS, _MOST_COARSE = 4000, 30_000  # wall points in the fine and in the coarse search
_REACH = 2.0  # metres: distances to walls are cut off here


class Fit(NamedTuple):
    """A pose and how well it fits.

    pose : from the new map's world frame to the old map's
    match : share of walls on walls, in [0, 1]
    overlap : share of the smaller map's walls on ground that the other map knows, in [0, 1]
    missed : metres of walls of either map that lie on no wall of the other
    """

    pose: Pose
    match: float
    overlap: float
    missed: float


@dataclass(frozen=True)
class Registration:
    """The best fit of two maps, and the best one at a clearly different pose (None if none comes near)."""

    best: Fit
    second: Fit | None


def register(a: "Walls", b: "Walls") -> Registration | None:
    """The pose that lays the new map `b` on `a`; None where a map has no walls or no pose has enough overlap."""
    a, b = _comparable(a, b)
    if len(a.points) < 2 or len(b.points) < 2:
        return None
    places, value = _searched(a, b, _coarse(a, b))
    places = places[np.argsort(-value, kind="stable")]
    places = places[_different(places, N_FINE)]
    rough = np.array([_rough_match(a, b, _pose(b, place)) for place in places])
    chosen = np.array([_refined(a, b, place) for place in places[rough >= rough.max() - MOST_BEHIND]])
    fits = [_fit(a, b, _pose(b, place)) for place in chosen]
    order = [
        k for k in np.argsort([-fit.match for fit in fits], kind="stable") if fits[k].overlap >= LEAST_OVERLAP
    ]
    if not order:
        return None
    second = [k for k in order[1:] if _differ(chosen[order[0]], chosen[k])]
    return Registration(fits[order[0]], fits[second[0]] if second else None)


def register_near(a: "Walls", b: "Walls") -> Fit | None:
    """The fit of `b` on `a` nearly as they lie; None where most walls do not lie on walls, or a map has none."""
    a, b = _comparable(a, b)
    if len(a.points) < 2 or len(b.points) < 2 or _rough_match(a, b, IDENTITY) < LEAST_ROUGH:
        return None
    return _fit(a, b, _pose(b, _refined(a, b, np.array([*b.middle, 0.0]))))


def _comparable(a: "Walls", b: "Walls") -> tuple["Walls", "Walls"]:
    """Two maps by their walls; by the border of their free ground if both have hardly a wall, such as of a yard.

    A part of a building may have hardly a wall, too, where its ground has gaps: the whole has walls.
    """
    return (a.border, b.border) if a.hardly_any and b.hardly_any else (a, b)


# ---- walls -----------------------------------------------------------------------------------------


class Walls:
    """The walls of a map as points in metres of its world frame, and what lies near them.

    With `by_border`, all of the border of its free ground is in their place.
    """

    def __init__(self, occupancy: OccupancyMap, by_border: bool = False) -> None:
        self.map = occupancy
        state, self.pixel = occupancy.state, occupancy.resolution
        border = (state != FREE) & inflate(state == FREE, 2**0.5)
        walls = border & (state == OCCUPIED)
        self.hardly_any = bool(walls.sum() < LEAST_WALLED * border.sum())
        self.edge = border if by_border else walls
        rows, columns = np.nonzero(self.edge)
        self.width = state.shape[1] + 1  # with an empty column, so that no row continues in the next one
        self.numbers = rows * self.width + columns
        self.points = occupancy.metres(np.column_stack([rows, columns]))
        self.middle = self.points.mean(axis=0) if len(self.points) else np.zeros(2)

    @cached_property
    def border(self) -> "Walls":
        """The border of free ground in place of the walls."""
        return Walls(self.map, by_border=True)

    @cached_property
    def few(self) -> NDArray[np.float64]:
        """At most `_MOST_POINTS` of the points, evenly chosen."""
        return self.points[:: -(-len(self.points) // _MOST_POINTS)]

    @cached_property
    def distance(self) -> NDArray[np.float32]:
        """Metres from each pixel to the nearest wall, at most `_REACH`."""
        away = ndimage.distance_transform_edt(~self.edge) * self.pixel  # type: ignore[operator]
        return np.minimum(away, _REACH).astype(np.float32)

    @cached_property
    def ground(self) -> NDArray[np.uint8]:
        """2 within `WALL_TOLERANCE` of a wall, else 1 where a pixel is known or lies by a known one, else 0."""
        known = inflate(self.map.state != UNKNOWN, np.ceil(2 * WALL_TOLERANCE / self.pixel))
        return known + (known & inflate(self.edge, WALL_TOLERANCE / self.pixel)).astype(np.uint8)


def moved(pose: Pose, points: NDArray[Any]) -> NDArray[np.float64]:
    """Points (n, 2) turned and shifted by a pose."""
    cos, sin = np.cos(pose[2]), np.sin(pose[2])
    return points @ np.array([[cos, sin], [-sin, cos]]) + pose[:2]


def inverse(pose: Pose) -> Pose:
    """The pose that undoes a pose."""
    dx, dy = moved((0.0, 0.0, -pose[2]), np.array([[-pose[0], -pose[1]]]))[0]
    return float(dx), float(dy), -pose[2]


def composed(outer: Pose, inner: Pose) -> Pose:
    """The pose that applies `inner`, then `outer`."""
    dx, dy = moved(outer, np.array([inner[:2]]))[0]
    return float(dx), float(dy), outer[2] + inner[2]


# ---- search: a place is (x, y, yaw) of the new map's middle in the old frame -----------------------


def _pose(b: Walls, place: NDArray[np.float64]) -> Pose:
    yaw = float((place[2] + np.pi) % (2 * np.pi) - np.pi)
    x, y = place[:2] - moved((0.0, 0.0, yaw), b.middle[None])[0]
    return float(x), float(y), yaw


def _differ(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether places are clearly different; the arguments broadcast."""
    turn = np.abs((one[..., 2] - other[..., 2] + np.pi) % (2 * np.pi) - np.pi)
    apart = np.hypot(one[..., 0] - other[..., 0], one[..., 1] - other[..., 1])
    return (turn > TURNED) | (apart > FAR)


def _different(places: NDArray[np.float64], most: int) -> list[int]:
    """Numbers of the first `most` places that differ from all chosen before them."""
    chosen: list[int] = []
    left = np.ones(len(places), dtype=bool)
    while left.any() and len(chosen) < most:
        chosen.append(int(left.argmax()))
        left &= _differ(places, places[chosen[-1]])
    return chosen


def _coarse(a: Walls, b: Walls) -> NDArray[np.float64]:
    """The best places that differ, (n, 3), by correlation of coarse pictures at every angle."""
    around = b.points - b.middle
    radius = np.hypot(*around.T).max()
    around = around[:: -(-len(around) // _MOST_COARSE)]
    pixel = max(COARSE_PIXEL, max(np.ptp(a.points, axis=0).max(), 2 * radius) / COARSE_SIDE)
    radius += pixel
    low = a.points.min(axis=0) - 2 * pixel
    n_a = np.ceil(np.ptp(a.points, axis=0) / pixel).astype(int) + 4
    n_b = int(np.ceil(2 * radius / pixel)) + 1
    shape = np.array([fft.next_fast_len(int(n) + n_b, real=True) for n in n_a], np.int64)
    field: Any = fft.rfft2(_coarse_field(a, low, n_a, pixel), shape)
    angles = np.arange(0, 2 * np.pi, COARSE_STEP)
    values, places = np.empty((len(angles), N_PEAKS)), np.empty((len(angles), N_PEAKS, 3))
    for k, angle in enumerate(angles):
        cell = np.floor((moved((0.0, 0.0, angle), around) + radius) / pixel).astype(np.int64)
        picture = np.bincount(cell[:, 0] * n_b + cell[:, 1], minlength=n_b * n_b).reshape(n_b, n_b)
        turned: Any = fft.rfft2(picture.astype(np.float32), shape)
        score: Any = fft.irfft2(field * np.conj(turned), shape)
        values[k], shift = _peaks(score, pixel)
        shift = np.where(shift < n_a, shift, shift - shape)
        places[k, :, :2], places[k, :, 2] = low + shift * pixel + radius, angle
    places = places.reshape(-1, 3)[np.argsort(-values.ravel(), kind="stable")]
    return places[_different(places, N_COARSE)]


def _coarse_field(a: Walls, low: NDArray, shape: NDArray, pixel: float) -> NDArray[np.float32]:
    """Blurred walls less their mean over known ground, 0 elsewhere: a picture by (x, y)."""
    cell = np.floor((a.points - low) / pixel).astype(np.int64)
    walls = np.bincount(cell[:, 0] * shape[1] + cell[:, 1], minlength=shape[0] * shape[1]).reshape(shape)
    blurred = ndimage.gaussian_filter(np.minimum(walls * a.pixel / pixel, 1.0), 1.0)
    points = low + (np.argwhere(np.ones(shape)) + 0.5) * pixel
    known = a.map.values_at(points, a.ground, 0).reshape(shape) > 0
    return np.where(known, blurred - blurred[known].mean(), 0.0).astype(np.float32)


def _peaks(score: NDArray, pixel: float) -> tuple[list[float], NDArray[np.int64]]:
    """The `N_PEAKS` highest values that are at least `FAR` apart, and where they are."""
    reach, values, places = int(np.ceil(FAR / pixel)), [], []
    for _ in range(N_PEAKS):
        at = np.unravel_index(int(score.argmax()), score.shape)
        values.append(float(score[at]))
        places.append(at)
        near = (np.arange(k - reach, k + reach + 1) % size for k, size in zip(at, score.shape, strict=True))
        score[np.ix_(*near)] = -np.inf
    return values, np.array(places, np.int64)


def _searched(a: Walls, b: Walls, places: NDArray[np.float64]):
    """The best place among fine steps around each coarse one, and its likelihood."""
    reach = int(np.ceil(FINE_REACH / a.pixel))
    likely = np.pad(np.exp(-0.5 * (a.distance / FINE_BLUR) ** 2), reach)
    step = max(1, int(0.1 / a.pixel))
    steps = np.arange(-reach + reach % step, reach + 1, step)
    shifts = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
    offsets = shifts @ np.array([likely.shape[1], 1])
    points = b.few[::3] - b.middle
    best, value = places.copy(), np.full(len(places), -np.inf)
    for k, (x, y, yaw) in enumerate(places):
        for turn in FINE_TURNS:
            row, column = np.rint(a.map.pixels(moved((x, y, yaw + turn), points))).T.astype(np.int64)
            inside = (row >= 0) & (row < a.edge.shape[0]) & (column >= 0) & (column < a.edge.shape[1])
            at = ((row + reach) * likely.shape[1] + column + reach)[inside]
            score = likely.ravel()[offsets[:, None] + at].sum(axis=1)
            i = int(score.argmax())
            if score[i] > value[k]:
                value[k] = score[i]
                along = moved((0.0, 0.0, a.map.origin[2]), np.array([[shifts[i, 1], -shifts[i, 0]]]) * a.pixel)[0]
                best[k] = x + along[0], y + along[1], yaw + turn
    return best, value


def _refined(a: Walls, b: Walls, place: NDArray[np.float64]) -> NDArray[np.float64]:
    """The place below a pixel, by robust least squares on the distances to walls."""
    points = b.few - b.middle
    arm = max(float(np.hypot(*points.T).mean()), a.pixel)  # a turn times this moves the walls as far as a shift

    def residual(change: NDArray) -> NDArray:
        there = moved((place[0] + change[0], place[1] + change[1], place[2] + change[2] / arm), points)
        return ndimage.map_coordinates(a.distance, a.map.pixels(there).T, order=1, mode="nearest")

    change = np.zeros(3)
    for scale in (0.3, 0.05):
        change = least_squares(residual, change, loss="cauchy", f_scale=scale, diff_step=1e-3, x_scale=0.1).x
    return place + change / (1, 1, arm)


def _rough_match(a: Walls, b: Walls, pose: Pose) -> float:
    """Share of walls on walls, of few points of each map and with specks; without any, 0."""
    ground = np.concatenate([
        a.map.values_at(moved(pose, b.few), a.ground, 0), b.map.values_at(moved(inverse(pose), a.few), b.ground, 0)
    ])  # fmt: skip
    return float((ground == 2).sum() / max((ground > 0).sum(), 1))


def _fit(a: Walls, b: Walls, pose: Pose) -> Fit:
    hits, seen, misses, metres = 0, 0, 0, 0.0
    for here, other, back in ((a, b, pose), (b, a, inverse(pose))):
        ground = here.map.values_at(moved(back, other.points), here.ground, 0)
        seen += int((ground > 0).sum())
        hits += int((ground == 2).sum())
        missed = _clustered(other, ground == 1)
        misses, metres = misses + missed, metres + missed * other.pixel
    # Pixels of different sizes draw the same wall with different numbers of points.
    smaller = min(len(a.points), len(b.points))
    return Fit(pose, hits / (hits + misses) if hits else 0.0, min(seen / (2 * smaller), 1.0), metres)


def _clustered(walls: Walls, missed: NDArray[np.bool_]) -> int:
    """Number of missed walls, without specks: a mapper's noise is scattered, a changed wall is not."""
    pixel = walls.numbers[missed]
    n = len(pixel)
    if not n:
        return 0
    # Of the eight neighbours of a pixel, four come after it in reading order.
    steps = np.array([1, walls.width - 1, walls.width, walls.width + 1])
    at = np.minimum(np.searchsorted(pixel, pixel + steps[:, None]), n - 1)
    touch = pixel[at] == pixel + steps[:, None]
    pairs = np.nonzero(touch)[1], at[touch]
    graph = sparse.coo_matrix((np.ones(len(pairs[0]), bool), pairs), shape=(n, n))
    size = np.bincount(csgraph.connected_components(graph, directed=False)[1])
    return int(size[size > SPECK].sum())
