"""Places that a walking person sees from each other, against exact geometry."""

from fractions import Fraction

import numpy as np

from examples.pages.walk.sight import visible_places
from lifelore.domains import OccupancyMap, building_from_map, floor_of
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED


def touches(a, b, pixel) -> bool:
    """Whether the line from a to b has a point in common with the closed square of a pixel, in exact numbers."""
    low, high = Fraction(0), Fraction(1)
    for start, end, centre in zip(a, b, pixel, strict=True):
        near, far = Fraction(2 * centre - 1, 2) - start, Fraction(2 * centre + 1, 2) - start
        along = end - start
        if along == 0:
            if not near <= 0 <= far:
                return False
            continue
        enter, leave = sorted((near / along, far / along))
        low, high = max(low, enter), min(high, leave)
    return low <= high


def test_sight_is_that_of_exact_geometry():
    random = np.random.default_rng(0)
    state = np.full((9, 10), OCCUPIED, np.uint8)
    state[1:-1, 1:-1] = np.where(random.random((7, 8)) < 0.15, OCCUPIED, FREE)
    occupancy = OccupancyMap(state, 0.5, (0.0, 0.0, 0.0))
    world = building_from_map(occupancy, 0.5, 0.0)
    floor = floor_of(occupancy, world)
    visible = visible_places(floor, world, 3.0).toarray()
    solid = np.argwhere(floor.solid).tolist()
    anchors = floor.anchors.tolist()
    for s, a in enumerate(anchors):
        for t, b in enumerate(anchors):
            near = (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 <= 6**2
            clear = near and not any(touches(a, b, pixel) for pixel in solid)
            assert visible[s, t] == (clear or t in world.neighbour[s])
