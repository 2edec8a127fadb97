"""Days in a building: blocked passages, crowds and their costs by hand, and the best return."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains import GridWorld, building_from_map, office_map
from lifelore.domains.buildings.building_days import CROWD, DAYS, MOVE, REFUSED, BuildingWay, Day, day_in

OFFICE = building_from_map(office_map(0))


def ring():
    """Eight cells around a pillar, numbered row by row: 0 1 2 / 3 4 / 5 6 7."""
    free = np.ones((3, 3), bool)
    free[1, 1] = False
    return GridWorld.from_free("ring", free)


def way(blocked=(), crowded=(), start=0, destination=2):
    world = ring()
    neighbour = world.neighbour.copy()
    closed = np.isin(np.arange(8), list(blocked))
    neighbour[closed] = -1
    neighbour[np.isin(neighbour, list(blocked))] = -1
    return BuildingWay(world, Day(neighbour, np.isin(np.arange(8), list(crowded)), ~closed), start, destination)


@pytest.mark.parametrize(
    ("blocked", "crowded", "best"),
    [((), (), 2 * MOVE), ((1,), (), 6 * MOVE), ((), (1,), 6 * MOVE), ((), (1, 6), CROWD + MOVE)],
)
def test_the_best_way_by_hand(blocked, crowded, best):
    assert way(blocked, crowded).best_return == best


def test_points_by_hand():
    task = way(blocked=(1,), crowded=(6,))
    task.reset()
    east, south, north = 2, 1, 0
    points = [task.step(action)[1] for action in (east, south, south, east, east, north, north)]
    assert points == [REFUSED, MOVE, MOVE, CROWD, MOVE, MOVE, MOVE]
    assert task.ended
    with pytest.raises(InputError):
        task.step(0)


@pytest.mark.parametrize("name", DAYS)
def test_a_day_keeps_the_building_in_one_piece(name):
    day, again = day_in(OFFICE, name), day_in(OFFICE, name)
    assert np.array_equal(day.neighbour, again.neighbour)
    assert day.open.mean() >= 0.9
    assert (~day.open).any() == (DAYS[name][0] > 0)
    assert day.crowded.any() == (DAYS[name][1] > 0)
    assert not (day.crowded & ~day.open).any()
    for cell in np.flatnonzero(day.open)[:: OFFICE.n_states // 5]:
        other = int(np.flatnonzero(day.open)[0])
        if cell != other:
            assert np.isfinite(BuildingWay(OFFICE, day, other, int(cell)).best_return)


def test_mistakes_are_refused():
    with pytest.raises(NotFoundError, match="type of day"):
        day_in(OFFICE, "holiday")
    with pytest.raises(InputError, match="different open cells"):
        way(blocked=(2,))
