"""A map as a mapper might save it again: padded or shifted; other edits are those of claim O4."""

from dataclasses import replace

import numpy as np

from lifelore.domains.buildings.occupancy_map import UNKNOWN, OccupancyMap
from lifelore.domains.buildings.registration import composed


def padded(occupancy: OccupancyMap, pixels: int = 7) -> OccupancyMap:
    """The same ground in the same frame, with unknown pixels all around."""
    state = np.pad(occupancy.state, pixels, constant_values=UNKNOWN)
    by = -pixels * occupancy.resolution
    return replace(occupancy, state=state, origin=composed(occupancy.origin, (by, by, 0.0)))


def shifted(occupancy: OccupancyMap, dx: float = 3.37, dy: float = -1.2) -> OccupancyMap:
    """The same pixels in a world frame with another origin."""
    x, y, yaw = occupancy.origin
    return replace(occupancy, origin=(x + dx, y + dy, yaw))
