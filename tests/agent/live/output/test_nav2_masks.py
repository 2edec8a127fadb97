"""Masks worked by hand, on the grid of the user's own map, and read back as nav2 reads them."""

import math

import numpy as np
import pytest

from lifelore.agent.live.output.nav2_masks import (
    FULL_SPEED,
    KEEP_OUT,
    MOST_COST,
    NO_OPINION,
    SLOWEST,
    body_space,
    keepout_mask,
    on_map,
    place_costs,
    place_masks,
    place_speeds,
    write_masks,
)
from lifelore.agent.travel.move_costs import DETOUR, MoveCosts
from lifelore.domains.buildings.building import building_from_map
from lifelore.domains.buildings.floor import Floor, floor_of
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, OccupancyMap, read_occupancy_map
from lifelore.domains.grids.grid_world import GridWorld

NORTH, SOUTH, EAST, WEST = range(4)


def costs_of(
    world: GridWorld,
    slow: dict[tuple[int, int], float] | None = None,
    refused: dict[tuple[int, int], float] | None = None,
) -> MoveCosts:
    """Costs where a usual move takes 1 s; `refused` are expected seconds of refusals."""
    seconds, blocked = np.ones((world.n_states, 4)), np.zeros((world.n_states, 4))
    for move, value in (slow or {}).items():
        seconds[move] = value
    for move, value in (refused or {}).items():
        blocked[move] = value / DETOUR
    return MoveCosts(world, seconds, blocked)


@pytest.fixture
def long_corridor() -> GridWorld:
    return GridWorld.from_free("corridor", np.ones((1, 7), bool))


ALL = np.ones(7, bool)


def test_a_slow_move_costs_on_both_its_places(long_corridor):
    costs = costs_of(long_corridor, {(2, EAST): 5.0})
    # Places 2 and 3 have 4 moves with 8 s in sum; 100 · (1 - 1/2). A usual place has moves of 1 s.
    assert place_costs(costs, ALL).tolist() == [0, 0, 50, 50, 0, 0, 0]
    assert place_speeds(costs, ALL).tolist() == [FULL_SPEED] * 2 + [50] * 2 + [FULL_SPEED] * 3


def test_a_building_that_is_slow_everywhere_is_usual(long_corridor):
    everywhere = {(state, action): 7.0 for state in range(7) for action in range(4)}
    assert set(place_costs(costs_of(long_corridor, everywhere), ALL)) == {0}
    assert set(place_speeds(costs_of(long_corridor, everywhere), ALL)) == {FULL_SPEED}


def test_refusals_cost_and_do_not_limit_the_speed(long_corridor):
    costs = costs_of(long_corridor, refused={(2, EAST): 4.0, (0, WEST): 10.0})
    # The move west of place 0 leads into a wall, which nav2 inflates itself.
    assert place_costs(costs, ALL).tolist() == [0, 0, 50, 50, 0, 0, 0]
    assert set(place_speeds(costs, ALL)) == {FULL_SPEED}


def test_costs_and_speeds_have_their_limits(long_corridor):
    costs = costs_of(long_corridor, {(2, EAST): 1e4, (5, EAST): 1.2})
    assert place_costs(costs, ALL).tolist() == [0, 0, MOST_COST, MOST_COST, 0, 0, 0]
    assert place_speeds(costs, ALL).tolist()[2:] == [SLOWEST] * 2 + [FULL_SPEED] * 3


def test_places_never_visited_have_no_opinion(long_corridor):
    costs, known = costs_of(long_corridor, {(2, EAST): 5.0}), np.arange(7) != 3
    assert place_costs(costs, known).tolist() == [0, 0, 50, NO_OPINION, 0, 0, 0]
    assert place_speeds(costs, known)[3] == FULL_SPEED
    assert set(place_costs(costs, np.zeros(7, bool))) == {NO_OPINION}


def room(origin=(0.0, 0.0, 0.0)) -> tuple[OccupancyMap, GridWorld, Floor]:
    """A room of 3 x 2 m within a wall of one pixel of 0.1 m."""
    state = np.ones((22, 32), np.uint8)
    state[1:-1, 1:-1] = FREE
    occupancy = OccupancyMap(state, 0.1, origin)
    world = building_from_map(occupancy, 0.5, 0.2)
    return occupancy, world, floor_of(occupancy, world)


def test_the_body_of_a_robot_in_known_places_stays_off_walls():
    occupancy, world, floor = room()
    space = body_space(floor, np.ones(world.n_states, bool))
    # Centres are free from the third pixel off the wall on. A body of two pixels reaches the pixel beside the
    # wall, but not the corner: its distance from the nearest centre is √8 pixels.
    assert space[1, 3:-3].all()
    assert not space[1, 1]
    assert not (space & (occupancy.state != FREE)).any()


def test_masks_of_a_half_known_room():
    occupancy, world, floor = room()
    x = world.positions(np.arange(world.n_states))[:, 0]
    known = x < 1.5
    keepout = keepout_mask(floor, known)
    assert set(np.unique(keepout)) == {0, KEEP_OUT}
    assert keepout[10, 12] == 0
    assert keepout[10, 16] == 0  # the robot's body at 1.45 m reaches to 1.65 m
    assert keepout[10, 17] == KEEP_OUT
    (costs,) = place_masks(floor, known, (np.full(world.n_states, 7, np.uint8), NO_OPINION))
    assert costs[10, 12] == 7
    assert costs[10, 20] == costs[0, 5] == NO_OPINION
    assert ((costs == 7) <= (occupancy.state == FREE)).all()


def test_a_mask_is_laid_on_the_users_own_map():
    """The floor lies on a grid turned by a quarter; the same places are meant."""
    turned, world, floor = room((5.0, 1.0, math.pi / 2))
    mask = np.where(floor.state >= 0, 3, 9).astype(np.uint8)
    # The user's map of the same ground: 22 pixels wide, 32 high, lower left corner at (5 - 2.2, 1).
    own = OccupancyMap(np.rot90(turned.state).copy(), 0.1, (5.0 - 2.2, 1.0, 0.0))
    assert np.array_equal(on_map(mask, floor, own, 1), np.rot90(mask))
    wide = OccupancyMap(np.zeros((34, 22), np.uint8), 0.1, (5.0 - 2.2, 1.0, 0.0))
    assert np.array_equal(on_map(mask, floor, wide, 1), np.vstack([np.full((2, 22), 1), np.rot90(mask)]))
    assert world.n_states > 0


def test_masks_are_written_in_the_scale_of_nav2(tmp_path):
    occupancy, world, floor = room((-1.0, 2.0, 0.0))
    write_masks(tmp_path, costs_of(world), np.ones(world.n_states, bool), floor, occupancy)
    keepout = read_occupancy_map(tmp_path / "keepout.yaml")
    assert (keepout.state.shape, keepout.resolution, keepout.origin) == ((22, 32), 0.1, (-1.0, 2.0, 0.0))
    assert np.array_equal(keepout.state == FREE, body_space(floor, np.ones(world.n_states, bool)))
    for name, first, values in (("costs", "Time and risk", {0, NO_OPINION}), ("speed", "Percent", {FULL_SPEED})):
        text = (tmp_path / f"{name}.yaml").read_text(encoding="utf-8")
        assert text.startswith(f"# {first}")
        assert "mode: raw" in text
        header, pixels = (tmp_path / f"{name}.pgm").read_bytes().split(b"\n255\n", 1)
        assert header == b"P5\n32 22"
        assert set(pixels) == values


def test_the_masks_of_a_turned_map_have_no_yaw_and_keep_out_of_its_walls(tmp_path):
    """nav2 ignores the yaw of a mask's origin: pixel (i, j) covers origin + (j, i) · resolution."""
    occupancy, world, floor = room((-1.0, 2.0, 0.3))
    write_masks(tmp_path, costs_of(world), np.ones(world.n_states, bool), floor, occupancy)
    keepout = read_occupancy_map(tmp_path / "keepout.yaml")
    assert keepout.origin[2] == 0

    def seen(points: np.ndarray) -> np.ndarray:
        column, row = np.floor((points - keepout.origin[:2]) / keepout.resolution).astype(int).T
        return keepout.state[len(keepout.state) - 1 - row, column]

    assert (seen(floor.metres(np.argwhere(occupancy.state == OCCUPIED))) == OCCUPIED).all()
    # Two pixels off the walls on, the robot drives: at each of its places nothing is kept out.
    assert (seen(floor.metres(np.argwhere(floor.state >= 0))) == FREE).all()
    assert seen(np.array([keepout.origin[:2]]) + 0.05) == OCCUPIED  # outside of the picture


def test_a_place_that_is_now_blocked_is_kept_out(tmp_path):
    occupancy, world, floor = room()
    known, (east,) = np.ones(world.n_states, bool), world.states_at([(2.75, 1.25)])
    into = {
        (int(world.neighbour[east, back]), back ^ 1): 54.0 for back in range(4) if world.neighbour[east, back] >= 0
    }
    write_masks(tmp_path, costs_of(world, refused=into), known, floor, occupancy)
    keepout = read_occupancy_map(tmp_path / "keepout.yaml").state
    assert keepout[9, 29] == OCCUPIED
    assert keepout[9, 12] == FREE


def test_equal_obstacles_cost_alike(tmp_path):
    """Table legs at distances that are no multiple of a cell: none costs anything, whatever cell it lies in."""
    state = np.ones((62, 122), np.uint8)
    state[1:-1, 1:-1] = FREE
    legs = [(row, column) for row in (15, 40) for column in range(13, 115, 17)]
    for leg in legs:
        state[leg] = OCCUPIED
    occupancy = OccupancyMap(state, 0.05)
    world = building_from_map(occupancy, 0.5, 0.2)
    floor, known = floor_of(occupancy, world), np.ones(world.n_states, bool)
    write_masks(tmp_path, costs_of(world), known, floor, occupancy)
    costs = np.frombuffer((tmp_path / "costs.pgm").read_bytes()[-state.size :], np.uint8).reshape(state.shape)
    assert set(np.unique(costs)) == {0, NO_OPINION}
    assert len({costs[row - 3 : row + 4, column - 3 : column + 4].tobytes() for row, column in legs}) == 1
