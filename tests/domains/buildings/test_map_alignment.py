"""Maps resampled on an earlier map's grid."""

import numpy as np
import pytest

from lifelore.domains import OccupancyMap, building_from_map, office_map
from lifelore.domains.buildings.map_alignment import MapFrame, aligned_map
from lifelore.domains.buildings.occupancy_map import FREE, UNKNOWN
from lifelore.domains.buildings.registration import IDENTITY, moved
from reproduction.own.o_04_same_building.edits import turned
from tests.domains.buildings.resaved_maps import padded, shifted

OFFICE = office_map(1, 20.0, 14.0)
FRAME = MapFrame.of(OFFICE)


def test_a_padded_map_becomes_the_same_world():
    laid, corner = aligned_map(padded(OFFICE), IDENTITY, FRAME, 0.5)
    assert corner == (0, 0)
    assert np.array_equal(laid.state, OFFICE.state)
    assert building_from_map(laid).fingerprint == building_from_map(OFFICE).fingerprint


def test_positions_stay_in_the_new_maps_frame():
    new = shifted(OFFICE, 3.0, -2.0)
    laid, _ = aligned_map(new, (-3.0, 2.0, 0.0), FRAME, 0.5)
    assert np.array_equal(laid.state, OFFICE.state)
    world, old = building_from_map(laid), building_from_map(OFFICE)
    states = np.arange(old.n_states)
    assert world.positions(states) == pytest.approx(old.positions(states) + np.array([3.0, -2.0]))


def test_a_turned_map_keeps_its_metres():
    new = turned(OFFICE, 30.0)
    middle = np.array(OFFICE.state.shape[::-1]) * 0.05 / 2
    new_middle = np.array(new.state.shape[::-1]) * 0.05 / 2
    turn = (0.0, 0.0, np.radians(-30.0))
    pose = (*(middle - moved(turn, new_middle[None])[0]), turn[2])
    laid, corner = aligned_map(new, pose, FRAME, 0.5)
    assert corner == (0, 0)
    assert np.mean(laid.state != OFFICE.state) < 0.05  # resampled twice: thin edges differ
    # The lower left corner of the old picture, in the new frame: turned by 30° about the middle.
    expected = moved((0.0, 0.0, np.radians(30.0)), -middle[None])[0] + new_middle
    assert laid.origin == pytest.approx((*expected, np.radians(30.0)), abs=0.05)


def test_a_map_that_knows_more_has_more_cells_on_the_same_grid():
    small = OccupancyMap(np.full((20, 20), FREE, np.uint8), 0.1, (5.0, 5.0, 0.0))
    state = np.full((40, 40), UNKNOWN, np.uint8)
    state[:35, 5:] = FREE  # from 1.5 m left of and 1.5 m below the small one to 0.5 m above and beyond its right
    large = OccupancyMap(state, 0.1, (3.0, 3.0, 0.0))
    laid, corner = aligned_map(large, IDENTITY, MapFrame.of(small), 0.5)
    assert corner == (-3, -3)
    assert laid.origin == pytest.approx((3.5, 3.5, 0.0))
    assert laid.state.shape == (35, 35)
    assert (laid.state == FREE).all()
