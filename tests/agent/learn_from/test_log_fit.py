"""A log fits its map despite real noise; a log in another frame does not, and the offset between them is found."""

from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.learn_from.log_fit import MOST_OUTSIDE, Reachable, mending_shift, shifted_runs
from lifelore.domains.buildings.floor import floor_of
from lifelore.domains.buildings.occupancy_map import FREE, OccupancyMap, read_occupancy_map
from lifelore.domains.buildings.registration import moved as shifted
from lifelore.domains.worlds import WorldSettings, world_from_settings

from .robot_runs import driven_run

OFFICE = Path(__file__).parents[3] / "examples" / "data" / "office.yaml"


@pytest.fixture(scope="module")
def world():
    return world_from_settings(WorldSettings("building", OFFICE))


@pytest.fixture(scope="module")
def floor(world):
    return floor_of(read_occupancy_map(OFFICE), world)


@pytest.fixture(scope="module")
def reachable(floor):
    return Reachable.of(floor)


@pytest.fixture(scope="module")
def points(world):
    return np.concatenate([driven_run(world, number).points for number in range(12)])


def test_a_robot_that_hugs_walls_with_five_centimetres_of_noise_fits(floor, reachable):
    """Every pose at the least distance from a wall that the robot can have, with the noise of localisation."""
    edge = np.argwhere((floor.state >= 0) & (floor.distance <= floor.radius + 1))
    noise = np.random.default_rng(1).normal(0, 0.05, (len(edge), 2))
    assert reachable.outside(floor.metres(edge) + noise).mean() < MOST_OUTSIDE / 4


def test_poses_in_walls_in_the_unknown_and_beyond_the_map_lie_outside(floor, reachable):
    wall = floor.metres(np.argwhere((floor.occupancy.state != FREE) & ~reachable.near)[:50])
    assert reachable.outside(wall).all()
    assert reachable.outside(np.array([[-500.0, 0.0], [0.0, 1e5]])).all()
    assert not reachable.outside(floor.metres(floor.anchors[:50])).any()


@pytest.mark.parametrize("offset", [(5.0, -2.0, 0.0), (-0.9, 3.3, 0.0), (1.2, 2.0, np.deg2rad(3))])
def test_the_offset_that_mends_a_log_is_found(reachable, points, offset):
    moved = shifted(offset, points)
    assert reachable.outside(moved).mean() > MOST_OUTSIDE
    found = mending_shift(moved, reachable)
    mended = shifted(found[0], moved)
    assert np.hypot(*(mended - points).T).max() < 0.5
    assert reachable.outside(mended).mean() <= 0.01


def test_no_offset_is_named_where_none_or_several_mend(reachable, points):
    noise = np.random.default_rng(2).uniform(-15, 15, points.shape)
    assert mending_shift(points + noise, reachable) is None
    short = points[:3] + 60.0  # three poses lie inside almost everywhere
    assert mending_shift(short, reachable) is None
    millimetres = 1000 * points  # a picture of them would not fit into main memory
    assert mending_shift(millimetres, reachable) is None


def test_a_turned_map_is_searched_in_its_own_frame(world, points):
    """The same pixels with a turned origin: the log turns with them."""
    own = read_occupancy_map(OFFICE)
    x, y, yaw = own.origin
    turn = 0.4
    x, y = shifted((0.0, 0.0, turn), np.array([[x, y]]))[0]
    occupancy = OccupancyMap(own.state, own.resolution, (x, y, yaw + turn))
    floor = floor_of(occupancy, world_from_settings(WorldSettings("building", OFFICE), occupancy))
    moved = shifted((0.0, 0.0, turn), points) + np.array([3.0, 1.0])
    found = mending_shift(moved, Reachable.of(floor))
    assert np.allclose(found[0], (-3.0, -1.0, 0.0), atol=0.5)


def test_headings_turn_with_the_points(world):
    run = driven_run(world, 1)
    turned = shifted_runs([run], (1.0, 2.0, np.pi / 2))[0]
    assert np.allclose(turned.points, np.column_stack([1 - run.points[:, 1], 2 + run.points[:, 0]]))
    assert turned.digest != run.digest
