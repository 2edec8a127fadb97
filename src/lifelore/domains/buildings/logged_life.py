"""What a log of a life in a building holds: its map, costs, ways and events, with their times."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.buildings.occupancy_map import OccupancyMap


class LoggedLife(NamedTuple):
    """A life as a log; points are in metres of the map's frame, seconds those since 1970 by the robot's clock.

    occupancy : the user's map
    costs : (rows, columns) uint8, on its pixels, 0 to 100; larger values are unknown
    ways : (name, seconds, corners (n, 2)) of the last tasks
    events : (name, seconds, point): goals reached or missed, and moves refused

    A life without a clock has the number of its task in place of seconds, and no refusals.
    """

    occupancy: OccupancyMap
    costs: NDArray[np.uint8]
    ways: list[tuple[str, float, NDArray[np.float64]]]
    events: list[tuple[str, float, tuple[float, float]]]
