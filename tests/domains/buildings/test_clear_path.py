"""Paths in metres: worked by hand, compared with a visibility graph, and with the map by dense samples."""

import os
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import KDTree

from lifelore.core.errors import InputError
from lifelore.domains import GridWorld, OccupancyMap, building_from_map, floor_of, office_map, read_occupancy_map
from lifelore.domains.buildings.clear_path import clear_path
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, UNKNOWN


def building(occupancy: OccupancyMap, cell: float, radius: float) -> tuple[GridWorld, Floor]:
    world = building_from_map(occupancy, cell, radius)
    return world, floor_of(occupancy, world)


def room(rows: int, columns: int, **settings) -> OccupancyMap:
    """An empty room of pixels of 0.1 m within a wall of one pixel."""
    state = np.zeros((rows, columns), np.uint8)
    state[[0, -1], :] = state[:, [0, -1]] = OCCUPIED
    return OccupancyMap(state, 0.1, **settings)


def open_moves(world: GridWorld) -> np.ndarray:
    """Price 0 for every move of the world."""
    return np.where(world.neighbour >= 0, 0.0, np.inf)


def length_of(path: np.ndarray) -> float:
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def moves_among(world: GridWorld, states: np.ndarray) -> np.ndarray:
    """Price 0 for the moves among `states`, no other moves."""
    inside = np.isin(np.arange(world.n_states), states)
    return np.where((world.neighbour >= 0) & inside[:, None] & inside[world.neighbour], 0.0, np.inf)


def random_chain(world: GridWorld, rng: np.random.Generator) -> np.ndarray:
    """States of a shortest path between two random states."""
    start, goal = rng.integers(world.n_states, size=2)
    before = {int(start): -1}
    queue = [int(start)]
    for state in queue:
        for there in world.neighbour[state].tolist():
            if there >= 0 and there not in before:
                before[there] = state
                queue.append(there)
    chain = [int(goal)]
    while chain[-1] != start:
        chain.append(before[chain[-1]])
    return np.array(chain[::-1])


def least_clearance(path: np.ndarray, floor: Floor) -> float:
    """Pixels between the path and the nearest solid pixel centre, on samples a twentieth of a pixel apart."""
    tree = KDTree(np.argwhere(floor.solid))
    least = np.inf
    for a, b in pairwise(floor.pixels(path)):
        samples = np.linspace(a, b, int(np.hypot(*(b - a)) * 20) + 2)
        assert (floor.state[tuple(np.rint(samples).astype(int).T)] >= 0).all()
        least = min(least, tree.query(samples)[0].min())
    return least


def assert_clear(path: np.ndarray, floor: Floor) -> None:
    """No sample of the path is nearer to a solid pixel's centre than the radius, or off the floor's pixels."""
    assert not floor.solid.any() or least_clearance(path, floor) > floor.radius - 1e-9


def check_chains(world: GridWorld, floor: Floor, n: int, seed: int) -> None:
    """Paths over the cells of random chains alone, and over all cells: never longer."""
    rng = np.random.default_rng(seed)
    for _ in range(n):
        chain = random_chain(world, rng)
        ends = floor.metres(floor.anchors[chain[[0, -1]]])
        along, free = (clear_path(floor, *ends, price) for price in (moves_among(world, chain), None))
        for path in (along, free):
            assert np.array_equal(path[[0, -1]], ends) or len(path) == 1
            assert_clear(path, floor)
        visited = floor.state[tuple(np.rint(floor.pixels(along)).astype(int).T)]
        assert np.isin(visited, chain).all()


def test_an_empty_room_is_crossed_in_a_straight_line():
    _, floor = building(room(62, 82), 0.5, 0.2)
    path = clear_path(floor, (0.55, 0.55), (7.55, 5.55))
    assert np.allclose(path, [[0.55, 0.55], [7.55, 5.55]])


def test_the_path_around_the_end_of_a_wall_touches_the_circle_about_it():
    plan = room(62, 82)
    plan.state[20:, 40] = OCCUPIED  # a wall from the bottom up; its end is at row 20, x = 4.05 m, y = 4.15 m
    _, floor = building(plan, 0.5, 0.2)
    start, goal, corner, keep = (2.05, 1.05), (6.05, 1.05), np.array([4.05, 4.15]), 0.25
    path = clear_path(floor, start, goal)
    assert_clear(path, floor)
    # Two tangents, and the arc between the points where they touch: the angle between the lines to the ends, less
    # that between each line and the radius to the point of contact.
    away = np.hypot(*(corner - start))
    between = 2 * np.arctan2(2.0, corner[1] - start[1])
    arc = keep * (2 * np.pi - between - 2 * np.arccos(keep / away))
    shortest = 2 * np.sqrt(away**2 - keep**2) + arc
    assert shortest <= length_of(path) < 1.005 * shortest


def test_a_narrow_passage_is_used_where_there_is_no_other():
    plan = room(32, 62)
    plan.state[:, 30] = OCCUPIED
    plan.state[13:17, 30] = FREE  # between solid pixels 12 and 17: 0.25 m at the centre line, 0.2 m at its pixels
    _, floor = building(plan, 0.5, 0.19)
    path = clear_path(floor, (1.05, 2.55), (5.05, 0.55), clearance=0.27)
    assert_clear(path, floor)
    near = np.abs(floor.pixels(path)[:, 1] - 30) < 5
    assert (np.abs(floor.pixels(path)[near, 0] - 14.5) <= 0.6).all()
    plan.state[2:9, 30] = FREE  # a wider passage near by
    _, floor = building(plan, 0.5, 0.19)
    path = clear_path(floor, (1.05, 2.55), (5.05, 0.55), clearance=0.27)
    assert least_clearance(path, floor) > 2.7 - 1e-6


def test_a_slow_passage_is_avoided_where_the_way_around_is_cheaper():
    """Two doors in a wall; the price of the near one decides."""
    plan = room(62, 82)
    plan.state[:, 40] = OCCUPIED
    plan.state[5:15, 40] = plan.state[40:50, 40] = FREE
    world, floor = building(plan, 0.5, 0.2)
    into_near_door = (world.cells[:, 0] > 6) & (world.cells[:, 1] == 7)
    eastward = into_near_door[:, None] & (np.arange(4) == 2)
    ends = (2.05, 1.55), (6.05, 1.55)
    near, far = clear_path(floor, *ends), clear_path(floor, *ends, np.where(eastward, np.inf, 0))
    assert near[:, 1].max() < 2.5
    assert far[:, 1].max() > 4.5
    detour = length_of(far) - length_of(near)
    for share, expected in ((0.9, near), (1.1, far)):
        found = clear_path(floor, *ends, share * detour * eastward)
        assert length_of(found) == pytest.approx(length_of(expected), rel=0.01)
    back = clear_path(floor, *ends[::-1], 1.1 * detour * eastward)
    assert length_of(back) == pytest.approx(length_of(near), rel=0.005)


def test_without_moves_there_is_no_path():
    world, floor = building(room(22, 32), 0.5, 0.2)
    half = np.arange(world.n_states) < world.n_states // 2
    cut = np.where(half[:, None] == half[world.neighbour], open_moves(world), np.inf)
    ends = floor.metres(floor.anchors[[0, world.n_states - 1]])
    assert clear_path(floor, *ends, cut) is None
    assert clear_path(floor, *ends) is not None


def test_moves_have_a_direction():
    world, floor = building(room(12, 32), 1.0, 0.2)
    east = np.where(np.arange(4) == 2, open_moves(world), np.inf)
    ends = floor.metres(floor.anchors[[0, 2]])
    assert clear_path(floor, *ends, east) is not None
    assert clear_path(floor, *ends[::-1], east) is None


def test_a_path_changes_places_by_open_moves_alone():
    world, floor = building(room(60, 60), 1.0, 0.0)
    row, column = world.cells.T
    rim = np.flatnonzero((row == 5) | (column == 0))
    ends = floor.metres(floor.anchors[[world.state_of[0, 0], world.state_of[5, 5]]])
    around, across = (clear_path(floor, *ends, price) for price in (moves_among(world, rim), None))
    assert len(across) == 2
    assert {floor.state_at("path", tuple(point)) for point in around} <= set(rim.tolist())


def test_a_path_to_the_place_itself_is_a_point():
    world, floor = building(room(22, 32), 0.5, 0.2)
    path = clear_path(floor, (1.05, 1.05), (1.05, 1.05), np.full((world.n_states, 4), np.inf))
    assert path.tolist() == [[1.05, 1.05]]


@given(
    seed=st.integers(0, 2**32 - 1),
    radius=st.sampled_from([0.0, 0.1, 0.15, 0.2]),
    cell=st.sampled_from([0.1, 0.25, 0.3, 0.5]),
    yaw=st.sampled_from([0.0, 0.7, -2.0]),
)
def test_paths_on_small_maps_are_clear(seed, radius, cell, yaw):
    rng = np.random.default_rng(seed)
    state = rng.choice([FREE, OCCUPIED, UNKNOWN], size=rng.integers(8, 30, 2), p=[0.95, 0.03, 0.02])
    try:
        world, floor = building(OccupancyMap(state.astype(np.uint8), 0.1, (3.0, -2.0, yaw)), cell, radius)
    except InputError:
        return
    check_chains(world, floor, 2, seed)


@pytest.mark.parametrize("seed", range(3))
def test_paths_in_offices_are_clear(seed):
    check_chains(*building(office_map(seed), 0.5, 0.2), n=6, seed=seed)


@pytest.mark.slow
@pytest.mark.skipif("LIFELORE_DATA" not in os.environ, reason="LIFELORE_DATA is not set")
def test_paths_in_the_willow_building_are_clear():
    willow = read_occupancy_map(Path(os.environ["LIFELORE_DATA"]) / "maps" / "willow-full.yaml")
    check_chains(*building(willow, 0.5, 0.2), n=25, seed=0)
