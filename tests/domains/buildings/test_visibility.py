"""Places in sight of each other: by hand, against exact geometry, mutual, and hidden by walls."""

from fractions import Fraction

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.buildings import visibility
from lifelore.domains.buildings.building import building_from_map
from lifelore.domains.buildings.floor import floor_of
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, OccupancyMap
from lifelore.domains.buildings.office import office_map
from lifelore.domains.buildings.visibility import visible_places


def drawn(picture: str):
    """World and floor of a picture of pixels of 1 m, # occupied; a cell is a pixel, the robot a point."""
    rows = [line.strip() for line in picture.strip().splitlines()]
    state = np.where(np.array([list(row) for row in rows]) == "#", OCCUPIED, FREE).astype(np.uint8)
    occupancy = OccupancyMap(state, 1.0, (0.0, 0.0, 0.0))
    world = building_from_map(occupancy, 1.0, 0.0)
    return world, floor_of(occupancy, world)


def sights(picture: str, reach: float) -> dict[tuple[int, int], set[tuple[int, int]]]:
    """The pixels in sight of each free pixel."""
    world, floor = drawn(picture)
    visible = visible_places(floor, world, reach)
    pixels = [tuple(anchor) for anchor in floor.anchors.tolist()]
    return {
        p: {pixels[t] for t in visible.indices[slice(*visible.indptr[s : s + 2])]} for s, p in enumerate(pixels)
    }


ROOMS = """
    #########
    #...#...#
    #.......#
    #...#...#
    #########
"""


def test_a_wall_hides_and_a_door_shows():
    seen = sights(ROOMS, 100)
    # From the row of the door, the other room is seen along the row, and near the door a little to its sides.
    assert {p for p in seen[2, 1] if p[1] > 4} == {(2, 5), (2, 6), (2, 7)}
    assert {p for p in seen[2, 3] if p[1] > 4} == {(2, 5), (2, 6), (2, 7), (1, 7), (3, 7)}
    # The line from (1, 3) to (3, 5) passes through the middle of the door and touches the corners of its posts.
    assert (3, 5) not in seen[1, 3]
    # From the door all is seen except the places to which the line touches a post.
    assert seen[2, 4] == {(r, c) for r in (1, 2, 3) for c in (1, 2, 3, 5, 6, 7)} - {
        (1, 3), (3, 3), (1, 5), (3, 5)
    } | {(2, 4)}  # fmt: skip
    # In its own room everything is seen.
    assert {(r, c) for r in (1, 2, 3) for c in (1, 2, 3)} <= seen[1, 1]


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
