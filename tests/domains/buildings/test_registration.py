"""Poses of maps on maps: known motions are found, ambiguous and different buildings are told apart."""

import numpy as np
import pytest
from scipy import ndimage

from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, UNKNOWN, OccupancyMap
from lifelore.domains.buildings.office import office_map
from lifelore.domains.buildings.registration import (
    SPECK,
    Walls,
    _clustered,
    composed,
    inverse,
    moved,
    register,
    register_near,
)
from reproduction.own.o_04_same_building.edits import cropped, noisy, refurnished, turned
from reproduction.own.o_04_same_building.run import recognised
from tests.domains.buildings.resaved_maps import padded, shifted

OFFICE = office_map(1, 20.0, 14.0)


def hall(width: int = 200, height: int = 120) -> OccupancyMap:
    """An empty rectangular hall: half a turn maps it to itself."""
    state = np.full((height, width), UNKNOWN, np.uint8)
    state[10:-10, 10:-10] = OCCUPIED
    state[12:-12, 12:-12] = FREE
    return OccupancyMap(state, 0.1)


def test_poses_by_hand():
    quarter = (1.0, 2.0, np.pi / 2)
    assert moved(quarter, np.array([[3.0, 0.0]])) == pytest.approx(np.array([[1.0, 5.0]]))
    assert composed(quarter, inverse(quarter)) == pytest.approx((0, 0, 0), abs=1e-12)
    assert composed((1, 0, 0), quarter) == pytest.approx((2, 2, np.pi / 2))


def test_the_same_map_fits_perfectly_in_its_frame():
    for new in (OFFICE, padded(OFFICE)):
        fit = register_near(Walls(OFFICE), Walls(new))
        assert fit.pose == pytest.approx((0, 0, 0), abs=1e-3)
        assert (fit.match, fit.overlap) == (1.0, 1.0)


@pytest.mark.parametrize(
    ("edit", "yaw"),
    [
        (shifted, 0.0),
        (lambda m: noisy(turned(m, 3.0)), -3.0),
        (lambda m: turned(m, 90.0), -90.0),
        (lambda m: turned(m, -5.0, 0.1), 5.0),
        (lambda m: turned(cropped(m, 0.6), 137.0), -137.0),
        (lambda m: turned(refurnished(m, 0.2), 10.0), -10.0),
    ],
    ids=["shifted", "3° and noise", "90°", "coarser", "cropped", "refurnished"],
)
def test_a_map_saved_again_is_found_below_a_pixel(edit, yaw):
    new = edit(OFFICE)
    found = register(Walls(OFFICE), Walls(new))
    assert recognised(found)
    assert np.degrees(found.best.pose[2]) == pytest.approx(yaw, abs=0.05)
    if edit is shifted:
        assert found.best.pose[:2] == pytest.approx((-3.37, 1.2), abs=0.005)


def test_another_building_does_not_fit():
    found = register(Walls(OFFICE), Walls(office_map(2, 20.0, 14.0)))
    assert found is None or found.best.match < 0.75


def test_two_poses_of_a_symmetric_hall_fit_equally():
    found = register(Walls(hall()), Walls(turned(hall(), 20.0)))
    assert found.best.match - found.second.match < 0.05
    assert not recognised(found)


def test_a_map_without_walls_fits_nothing():
    blank = OccupancyMap(np.full((40, 40), FREE, np.uint8), 0.1)
    assert register(Walls(OFFICE), Walls(blank)) is None
    assert register_near(Walls(blank), Walls(OFFICE)) is None


def test_specks_are_counted_as_labels_of_the_picture_say():
    """Pixels that touch by sides or corners, also at the borders of the picture, where rows do not run on."""
    draw = np.random.default_rng(3)
    for _ in range(20):
        state = np.where(draw.random((30, 24)) < 0.4, OCCUPIED, FREE).astype(np.uint8)
        walls = Walls(OccupancyMap(state, 0.1))
        missed = draw.random(len(walls.points)) < draw.choice([0.0, 0.3, 0.9])
        picture = np.zeros(state.shape, bool)
        picture[walls.edge] = missed
        label = np.asarray(ndimage.label(picture, np.ones((3, 3)))[0])  # type: ignore[index]
        size = np.bincount(label.ravel())[1:]
        assert _clustered(walls, missed) == size[size > SPECK].sum()


def test_a_map_with_gaps_in_its_ground_is_compared_with_a_whole_one_by_walls():
    whole, state = Walls(hall()), hall().state
    state[(state == FREE) & (np.random.default_rng(0).random(state.shape) < 0.4)] = UNKNOWN
    gaps = Walls(OccupancyMap(state, 0.1))
    assert gaps.hardly_any
    for fit in (register(whole, gaps).best, register_near(gaps, whole)):
        assert fit.match > 0.95
