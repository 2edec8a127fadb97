"""Places in sight of each other: by hand, against exact geometry, mutual, and hidden by walls."""

from fractions import Fraction

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains import OccupancyMap, building_from_map, floor_of, office_map
from lifelore.domains.buildings import visibility
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED
from lifelore.domains.buildings.visibility import visible_places


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


@pytest.mark.parametrize("seed", range(1))
def test_sight_is_that_of_exact_geometry(seed):
    random = np.random.default_rng(seed)
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


def test_blocks_do_not_matter_and_too_many_pairs_are_refused(monkeypatch):
    occupancy = office_map(1)
    world = building_from_map(occupancy)
    floor = floor_of(occupancy, world)
    whole = visible_places(floor, world, 3.0)
    monkeypatch.setattr(visibility, "_BLOCK", 20_000)
    assert (visible_places(floor, world, 3.0) != whole).nnz == 0
    monkeypatch.setattr(visibility, "MOST_PAIRS", 1000)
    with pytest.raises(InputError, match="use a shorter range or a larger cell"):
        visible_places(floor, world, 3.0)
