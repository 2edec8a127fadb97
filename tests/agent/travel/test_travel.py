"""Knowledge about driving: remembered and merged, on any map of the building."""

import numpy as np
import pytest

from lifelore.agent.travel import Travel
from lifelore.agent.travel.move_costs import DETOUR
from lifelore.core.errors import InputError
from lifelore.domains.grids.cell_numbers import BuildingGrid
from lifelore.domains.grids.grid_world import Frame, GridWorld
from lifelore.memory import open_memory

NOON = 20_000 * 86_400.0 + 12 * 3600  # a Thursday


def corridor(length: int = 12, cell: float = 0.5) -> GridWorld:
    return GridWorld.from_free("building", np.ones((1, length), np.bool_), frame=Frame(cell))


def travel_in(world: GridWorld, corner=(0, 0)) -> Travel:
    return Travel(world, BuildingGrid("frame", corner, "house"))


def test_without_observations_all_is_nominal():
    travel = travel_in(corridor())
    assert travel.seconds(NOON) == pytest.approx(np.ones((12, 4)))  # 0.5 m at 0.5 m/s
    assert travel.news() == []
    has_move = travel.world.neighbour >= 0
    assert (travel.blocked(NOON)[has_move] < 0.02).all()
    assert (travel.blocked(NOON)[~has_move] == 1).all()
    assert np.isinf(travel.costs(NOON).cost[~has_move]).all()
    assert travel.costs(NOON).cost[0, 2] == pytest.approx(1 + DETOUR * 0.01)


def test_slow_moves_are_expected_to_be_slow_and_refused_ones_to_be_refused():
    travel = travel_in(corridor())
    travel.observe([2] * 6, [2] * 6, NOON + 60 * np.arange(6), [4.0] * 6)
    travel.observe([8], [2], [NOON], [np.nan])
    seconds, blocked = travel.seconds(NOON + 600), travel.blocked(NOON + 600)
    assert 3.0 < seconds[2, 2] < 4.2
    assert seconds[11, 3] < seconds[2, 2]
    assert blocked[8, 2] > 0.3
    assert blocked[10, 3] == blocked[8, 2]  # the other way into the same cell
    assert blocked[5, 2] < 0.1


def test_memory_adds_what_two_robots_observe_in_any_order(tmp_path):
    world, found = corridor(), []
    drives = {"a": ([2, 3], [2, 2], [NOON, NOON + 2], [3.0, np.nan]), "b": ([2], [2], [NOON], [5.0])}
    for order in ("ab", "ba"):
        with open_memory(str(tmp_path / f"{order}.db")) as memory:
            grid = travel_in(world).grid
            for robot in order:
                travel = travel_in(world)
                travel.observe(*drives[robot])
                memory.contribute(robot, travel.news(), process=robot, seq=0, task={})
                assert travel.news() == []
            recalled = Travel.recalled(world, grid, memory)
        assert recalled.passes.passes.tolist() == [2, 0]
        assert recalled.passes.refusals.tolist() == [0, 1]
        assert recalled.passes.log_seconds[0] == pytest.approx(np.log(15), abs=1e-5)
        assert recalled.news() == []
        found.append(recalled.costs(NOON + 600).cost)
    assert np.array_equal(*found)


def test_a_larger_map_of_the_building_finds_the_same_cells(tmp_path):
    small, large = corridor(8), corridor(12)
    with open_memory(str(tmp_path / "memory.db")) as memory:
        travel = travel_in(small)
        travel.observe([3], [2], [NOON], [7.0])
        memory.contribute("robot", travel.news(), process="a", seq=0, task={})
        # The large map begins two columns to the left of the first map: its corner is (0, -2).
        recalled = Travel.recalled(large, BuildingGrid("frame", (0, -2), "house"), memory)
        other_cells = Travel.recalled(corridor(8, 0.25), travel.grid, memory)
    assert recalled.passes.move.tolist() == [5 * 4 + 2]
    assert not len(other_cells.passes.move)
    recalled.observe([0], [2], [NOON], [1.0])
    assert recalled.news() == []  # left of the first map


def test_observations_of_another_decade_and_of_the_future_give_numbers():
    travel = travel_in(corridor())
    travel.observe([2, 2, 3], [2, 2, 2], [100.0, 200.0, 2 * NOON], [2.0, np.nan, 2.0])
    cost = travel.costs(NOON).cost[travel.world.neighbour >= 0]
    assert np.isfinite(cost).all()
    assert travel.blocked(NOON)[2, 2] < 0.1


@pytest.mark.parametrize(
    ("moves", "words"),
    [
        (([1, 2], [2], [NOON], [1.0]), "one length"),
        (([12], [2], [NOON], [1.0]), r"states must lie in \[0, 12\), got 12"),
        (([1], [4], [NOON], [1.0]), "actions must lie in"),
        (([1], [2], [-5.0], [1.0]), "clock must be seconds since 1970 below .*, got -5.0"),
        (([1], [2], [np.nan], [1.0]), "clock must be"),
        (([1], [2], [NOON], [0.0]), "seconds must be above 0, or NaN for a refused move, got 0.0"),
    ],
)
def test_bad_moves_are_refused_with_the_rule(moves, words):
    with pytest.raises(InputError, match=words):
        travel_in(corridor()).observe(*moves)
