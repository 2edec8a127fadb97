"""`Floor`: the places of a building at the resolution of its map; metres of the map's frame to pixels and back.

A `GridWorld` says which cells there are. A floor says which pixels each cell consists of, so that a path or a
point in metres can be compared with the map. Pixel coordinates are (row, column) with whole numbers at pixel
centres.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from lifelore.core.compiled.jit import kernel
from lifelore.core.errors import InputError
from lifelore.domains.buildings.free_space import pieces_of
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, UNKNOWN, OccupancyMap
from lifelore.domains.grids.grid_world import GridWorld


class Refusal(NamedTuple):
    """Why a robot's centre cannot be at a point.

    reason : words that follow the point
    known : whether the map knows the ground there
    nearest : x and y in metres of the nearest free place
    """

    reason: str
    known: bool
    nearest: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Floor:
    """Pixels of a building; made by `floor_of`.

    occupancy : the map
    state : (rows, columns) int32, state whose piece of free space holds the pixel; -1 where the robot has no place
    solid : (rows, columns) bool, pixels from whose centres the robot's centre stays farther than its radius
    robot_radius : metres
    neighbour : (n_states, 4) int32, the states whose pieces touch, north, south, east and west; -1 for none
    """

    occupancy: OccupancyMap
    state: NDArray[np.int32]
    solid: NDArray[np.bool_]
    robot_radius: float
    neighbour: NDArray[np.int32]

    @property
    def n_states(self) -> int:
        """Number of states of the building."""
        return len(self.neighbour)

    @property
    def radius(self) -> float:
        """The robot's radius in pixels."""
        return self.robot_radius / self.occupancy.resolution

    @cached_property
    def distance(self) -> NDArray[np.float64]:
        """(rows, columns) pixels from each pixel centre to the nearest solid one; inf if no pixel is solid."""
        if not self.solid.any():
            return np.full(self.solid.shape, np.inf)
        return np.asarray(ndimage.distance_transform_edt(~self.solid))

    def pixels(self, points: ArrayLike) -> NDArray[np.float64]:
        """Pixel coordinates (n, 2) of `points` (n, 2) in metres, see `OccupancyMap.pixels`."""
        return self.occupancy.pixels(points)

    def metres(self, pixels: ArrayLike) -> NDArray[np.float64]:
        """Points (n, 2) in metres of the map's frame, of (n, 2) pixel coordinates; the inverse of `pixels`."""
        return self.occupancy.metres(pixels)

    @cached_property
    def anchors(self) -> NDArray[np.int64]:
        """(n_states, 2) the pixel of each state that is farthest from solid pixels; the first in reading order."""
        pixel = np.flatnonzero(self.state >= 0)
        state = self.state.ravel()[pixel]
        order = np.lexsort((pixel, -self.distance.ravel()[pixel], state))
        first = np.searchsorted(state[order], np.arange(self.n_states))
        return np.column_stack(np.unravel_index(pixel[order][first], self.state.shape))

    @cached_property
    def middles(self) -> NDArray[np.float64]:
        """(n_states, 2) mean row and column of each state's pixels; 0 for a state without pixels."""
        return _middles(self.state, self.n_states)

    def state_at(self, name: str, point: tuple[float, float]) -> int:
        """The state in whose piece of free space a point lies; `name` is the argument that an error names.

        Raises
        ------
        InputError
            The robot's centre cannot be at the point; the message says why, and where the nearest free place is.
        """
        if refusal := self.refusal(point):
            x, y = refusal.nearest
            raise InputError(
                f"{name} must be a free place of this map, in metres of its frame; {point[0]:g},{point[1]:g} "
                f"{refusal.reason}; the nearest free place is {x:.3f},{y:.3f}"
            )
        return int(self.state[_nearest_pixel(self.pixels(point)[0])])

    def refusal(self, point: tuple[float, float]) -> "Refusal | None":
        """Why the robot's centre cannot be at a point in metres of the map's frame; None where it can."""
        pixel = self.pixels(point)[0]
        at = _nearest_pixel(pixel)
        inside = 0 <= at[0] < self.state.shape[0] and 0 <= at[1] < self.state.shape[1]
        if inside and self.state[at] >= 0 and self._clearance(pixel) > self.radius:
            return None
        x, y = self.metres(self._nearest(pixel))[0].tolist()
        known = inside and bool(self.occupancy.state[at] != UNKNOWN)
        return Refusal(self._why_not(at if inside else None), known, (x, y))

    def _clearance(self, pixel: NDArray[np.float64]) -> float:
        """Pixels to the nearest solid one; inf without any up to about two pixels beyond the radius."""
        reach = int(self.radius) + 2
        row, column = _nearest_pixel(pixel)
        top, left = max(row - reach, 0), max(column - reach, 0)
        near = np.argwhere(self.solid[top : row + reach + 1, left : column + reach + 1])
        return float(np.hypot(*(near + np.array([top, left]) - pixel).T).min(initial=np.inf))

    def _nearest(self, pixel: NDArray[np.float64]) -> NDArray[np.int64]:
        """The free pixel nearest to a pixel; the first of those in reading order."""
        rows, columns = np.ogrid[: self.state.shape[0], : self.state.shape[1]]
        away = np.where(self.state >= 0, (rows - pixel[0]) ** 2 + (columns - pixel[1]) ** 2, np.inf)
        return np.array(np.unravel_index(away.argmin(), away.shape))

    def _why_not(self, at: tuple[int, int] | None) -> str:
        if at is None:
            return "lies outside the map"
        seen = self.occupancy.state[at]
        if seen != FREE:
            return "is occupied" if seen == OCCUPIED else "is unknown"
        if self._clearance(np.array(at, float)) <= self.radius + 1:
            return f"is nearer to an obstacle than the robot's radius of {self.robot_radius:g} m"
        return "is free, but belongs to no place that the robot can reach"


def _nearest_pixel(pixel: NDArray[np.float64]) -> tuple[int, int]:
    """Whole row and column; on a border those of the larger numbers, as `clear_path` has them."""
    row, column = np.floor(pixel + 0.5).astype(int).tolist()
    return row, column


def floor_of(occupancy: OccupancyMap, world: GridWorld) -> Floor:
    """The floor of a building that `building_from_map` made of this map.

    Examples
    --------
    >>> from lifelore.domains.buildings.building import building_from_map
    >>> from lifelore.domains.buildings.office import office_map
    >>> office = office_map(seed=1, width_m=16.0, height_m=12.0)
    >>> world = building_from_map(office, cell=1.0, robot_radius=0.2)
    >>> floor_of(office, world).n_states == world.n_states
    True
    """
    about = world.about
    _, _, grid, largest = pieces = pieces_of(occupancy, about["cell"], about["robot_radius"])
    state = world.state_of[np.ix_(grid.row_of, grid.column_of)]
    return Floor(
        occupancy,
        np.where(largest, state, np.int32(-1)),
        pieces.solid,
        about["robot_radius"],
        world.neighbour,
    )


@kernel
def _middles(state, n_states):
    """`Floor.middles` of the pixels' states; 30 ms less than NumPy takes for 1,200 × 1,200 pixels."""
    sums, count = np.zeros((n_states, 2)), np.zeros((n_states, 1))
    for row in range(state.shape[0]):
        for column in range(state.shape[1]):
            at = state[row, column]
            if at >= 0:
                sums[at, 0] += row
                sums[at, 1] += column
                count[at, 0] += 1
    return sums / np.maximum(count, 1)
