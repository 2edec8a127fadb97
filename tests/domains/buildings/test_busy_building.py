"""A building with rush hours, drift, blocked places and doors: the same for the same seed, and as described."""

import numpy as np
import pytest
from scipy.sparse import csgraph

from lifelore.core.streams import stream
from lifelore.domains.buildings.busy_building import DAY, HOUR, MONDAY, N_DOORS, REFUSED_SECONDS, BusyBuilding
from lifelore.domains.buildings.busy_places import move_graph
from lifelore.domains.worlds import make_world


@pytest.fixture(scope="module")
def building() -> BusyBuilding:
    return BusyBuilding(make_world("building", seed=3), seed=5)


def way_in(building: BusyBuilding, start: int, end: int) -> np.ndarray:
    before = csgraph.shortest_path(
        move_graph(building.world.neighbour), indices=start, unweighted=True, return_predecessors=True
    )[1]
    way = [end]
    while way[-1] != start:
        way.append(before[way[-1]])
    return np.array(way[::-1])


def test_rush_hours_are_on_weekdays_and_drift_takes_weeks(building):
    night, sunday = building.seconds(MONDAY + 3 * HOUR), building.seconds(MONDAY + 6 * DAY)
    rush = np.array([building.seconds(MONDAY + hour * HOUR) for hour in range(7, 19)]).max(axis=0)
    at_noon = building.seconds(MONDAY + 6 * DAY + 12 * HOUR)
    assert (rush > 0.9 * night).all()  # half a day of drift
    assert (rush > 1.15 * night).mean() > 0.02
    assert at_noon == pytest.approx(sunday, rel=0.1)  # no rush on a Sunday; half a day of drift
    later = building.seconds(MONDAY + 21 * DAY + 3 * HOUR)
    assert (abs(np.log(later / night)) > 0.1).mean() > 0.02
    assert night.min() == pytest.approx(1.0)  # 0.5 m at 0.5 m/s


def test_doors_are_closed_at_night_and_places_are_blocked_at_times(building):
    days = np.arange(60)
    noon = np.array([building.blocked(MONDAY + day * DAY + 12 * HOUR) for day in days])
    night = np.array([building.blocked(MONDAY + day * DAY + 23 * HOUR) for day in days])
    doors = night.all(axis=0) & ~noon.any(axis=0)
    assert doors.sum() >= N_DOORS
    share = noon[:, noon.any(axis=0)].mean()
    assert 0.02 < share < 0.4  # 1.5 days of 11.5 are 0.13
    assert not noon[:, building.never_blocked].any()


def test_a_drive_ends_at_the_first_refused_move(building):
    clock = MONDAY + 23 * HOUR
    closed = np.flatnonzero(building.blocked(clock))
    door = next(c for c in closed if (~building.blocked(clock)[building.world.neighbour[c]]).any())
    start = int(np.flatnonzero(building.never_blocked)[0])
    drive = building.drive(way_in(building, start, int(door)), clock, stream(0, "drive"))
    assert np.isnan(drive.seconds[-1])
    assert not np.isnan(drive.seconds[:-1]).any()
    assert drive.end == pytest.approx(drive.clock[-1] + REFUSED_SECONDS)
    assert drive.clock == pytest.approx(clock + np.concatenate([[0], np.cumsum(drive.seconds[:-1])]))


def test_moves_take_their_median_seconds(building):
    a, b = np.flatnonzero(building.never_blocked)[[0, 1]]
    assert b in building.world.neighbour[a]
    clock = MONDAY + 12 * HOUR
    rng = stream(1, "drives")
    taken = [building.drive(np.array([a, b]), clock, rng).seconds[0] for _ in range(2000)]
    # The standard error of a median of 2,000 is 1.25 · 0.26 / √2000 = 0.7 %.
    assert np.median(taken) == pytest.approx(building.seconds(clock)[b], rel=0.03)
