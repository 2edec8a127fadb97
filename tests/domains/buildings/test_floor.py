"""The floor agrees with the grid world made of the same map, and points with its pixels."""

import math

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains import OccupancyMap, building_from_map, floor_of, office_map
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, UNKNOWN


def room(origin=(0.0, 0.0, 0.0)) -> OccupancyMap:
    """A room of 3 x 2 m within a wall of one pixel of 0.1 m, and unknown space to its right."""
    state = np.full((22, 42), UNKNOWN, np.uint8)
    state[:, :32] = OCCUPIED
    state[1:-1, 1:31] = FREE
    return OccupancyMap(state, 0.1, origin)


def test_metres_and_pixels_are_inverse_and_agree_with_the_world():
    occupancy = room((10.0, 20.0, math.pi / 2))
    world = building_from_map(occupancy, 0.1, 0.0)
    floor = floor_of(occupancy, world)
    # The centre of the lower left pixel, turned a quarter to the left about the origin.
    assert np.allclose(floor.metres([21, 0]), [[10 - 0.05, 20 + 0.05]])
    pixels = np.random.default_rng(0).uniform(0, 20, (50, 2))
    assert np.allclose(floor.pixels(floor.metres(pixels)), pixels)
    # Cells of one pixel: the centre of a cell is the centre of its only pixel.
    assert np.allclose(floor.metres(floor.anchors), world.positions(np.arange(world.n_states)))


def test_anchors_lie_in_their_own_piece_as_far_from_walls_as_can_be():
    occupancy = office_map(1)
    world = building_from_map(occupancy)
    floor = floor_of(occupancy, world)
    assert np.array_equal(floor.state[tuple(floor.anchors.T)], np.arange(world.n_states))
    for state in (0, 7, world.n_states - 1):
        own = floor.distance[floor.state == state]
        assert floor.distance[tuple(floor.anchors[state])] == own.max()


@pytest.mark.parametrize(
    ("point", "why", "nearest"),
    [
        ((-5.0, 1.05), "lies outside the map", "0.350,1.050"),
        ((0.05, 1.05), "is occupied", "0.350,1.050"),
        ((4.05, 1.05), "is unknown", "2.850,1.050"),
        ((0.15, 1.05), "is nearer to an obstacle than the robot's radius of 0.2 m", "0.350,1.050"),
    ],
)
def test_a_point_that_is_no_free_place_is_told_the_nearest(point, why, nearest):
    occupancy = room()
    floor = floor_of(occupancy, building_from_map(occupancy))
    with pytest.raises(InputError) as caught:
        floor.state_at("goal", point)
    message = str(caught.value)
    assert message.startswith("goal must be a free place")
    assert f"{point[0]:g},{point[1]:g} {why}" in message
    assert message.endswith(f"the nearest free place is {nearest}")
    x, y = (float(part) for part in nearest.split(","))
    assert floor.state_at("goal", (x, y)) >= 0


def test_a_refusal_names_the_nearest_free_place_near_and_far():
    """As all pixels together say, also from far outside the picture."""
    occupancy = office_map(1, 14.0, 12.0)
    floor = floor_of(occupancy, building_from_map(occupancy))
    free = floor.metres(np.argwhere(floor.state >= 0))
    points = [*np.random.default_rng(0).uniform((-3, -3), (20, 18), (60, 2)), (-300.0, 40.0), (9.0, 1e4)]
    refused = [(point, refusal) for point in points if (refusal := floor.refusal(tuple(point)))]
    assert len(refused) > 20
    for point, refusal in refused:
        away = np.hypot(*(free - point).T).min()
        assert math.dist(refusal.nearest, point) == pytest.approx(away, abs=1e-9)
    assert refused[-1][1].reason == "lies outside the map"
    assert not refused[-1][1].known
