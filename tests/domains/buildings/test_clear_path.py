"""Paths in metres: worked by hand, and every segment compared with the map by dense samples."""

import os
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import KDTree

from lifelore.core.errors import InputError
from lifelore.domains.buildings.building import building_from_map
from lifelore.domains.buildings.clear_path import clear_path
from lifelore.domains.buildings.floor import Floor, floor_of
from lifelore.domains.buildings.line_of_sight import LineOfSight, pixels_on_line
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, UNKNOWN, OccupancyMap, read_occupancy_map
from lifelore.domains.buildings.office import office_map
from lifelore.domains.grids.grid_world import GridWorld


def building(occupancy: OccupancyMap, cell: float, radius: float) -> tuple[GridWorld, Floor]:
    world = building_from_map(occupancy, cell, radius)
    return world, floor_of(occupancy, world)


def room(rows: int, columns: int, **settings) -> OccupancyMap:
    """An empty room of pixels of 0.1 m within a wall of one pixel."""
    state = np.zeros((rows, columns), np.uint8)
    state[[0, -1], :] = state[:, [0, -1]] = OCCUPIED
    return OccupancyMap(state, 0.1, **settings)


def all_moves(world: GridWorld) -> np.ndarray:
    state, action = np.nonzero(world.neighbour >= 0)
    return np.column_stack([state, world.neighbour[state, action]])


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


def assert_clear(path: np.ndarray, floor: Floor) -> None:
    """No sample of the path is nearer to a solid pixel's centre than the radius, or off the floor's pixels."""
    pixels = floor.pixels(path)
    tree = KDTree(np.argwhere(floor.solid)) if floor.solid.any() else None
    for a, b in pairwise(pixels):
        samples = np.linspace(a, b, int(np.hypot(*(b - a)) * 37) + 3)
        at = np.rint(samples).astype(int)
        assert (floor.state[tuple(at.T)] >= 0).all()
        if tree is not None:
            assert tree.query(samples)[0].min() > floor.radius - 1e-9


def check_chains(world: GridWorld, floor: Floor, n: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(n):
        chain = random_chain(world, rng)
        start, goal = floor.metres(floor.anchors[chain[[0, -1]]])
        path = clear_path(floor, np.column_stack([chain[:-1], chain[1:]]), start, goal)
        assert path is not None
        assert np.allclose(path[[0, -1]], [start, goal])
        assert_clear(path, floor)


def test_an_empty_room_is_crossed_in_a_straight_line():
    world, floor = building(room(62, 82), 0.5, 0.2)
    path = clear_path(floor, all_moves(world), (0.55, 0.55), (7.55, 5.55))
    assert path is not None
    assert np.allclose(path, [[0.55, 0.55], [7.55, 5.55]])


def test_the_path_leads_around_a_wall_and_keeps_away_from_its_end():
    plan = room(62, 82)
    plan.state[20:, 40] = OCCUPIED  # a wall from the bottom up; its end is at row 20, x = 4.05 m, y = 4.15 m
    world, floor = building(plan, 0.5, 0.2)
    path = clear_path(floor, all_moves(world), (2.05, 1.05), (6.05, 1.05))
    assert path is not None
    assert_clear(path, floor)
    corner = np.array([4.05, 4.15])
    # The straight line from the start to the end of the wall has the length of the hypotenuse; a detour of at most
    # the comfortable clearance (0.3 m) and a pixel on each side is allowed.
    shortest = 2 * np.hypot(*(corner - (2.05, 1.05)))
    length = np.hypot(*np.diff(path, axis=0).T).sum()
    assert shortest < length < shortest + 2.0
    assert np.hypot(*(path - corner).T).min() >= 0.3 - 1e-9


def test_a_narrow_passage_is_used_where_there_is_no_other():
    plan = room(32, 62)
    plan.state[:, 30] = OCCUPIED
    plan.state[13:18, 30] = FREE  # 0.5 m: a robot of 0.2 m fits at its centre line alone
    world, floor = building(plan, 0.5, 0.2)
    path = clear_path(floor, all_moves(world), (1.05, 2.55), (5.05, 0.55))
    assert path is not None
    assert_clear(path, floor)
    row, column = floor.pixels(path).T
    assert np.isclose(row[np.abs(column - 30).argmin()], 15)


def test_without_moves_there_is_no_path():
    world, floor = building(room(22, 32), 0.5, 0.2)
    some = all_moves(world)
    cut = some[(some < world.n_states // 2).all(axis=1) | (some >= world.n_states // 2).all(axis=1)]
    ends = floor.metres(floor.anchors[[0, world.n_states - 1]])
    assert clear_path(floor, cut, *ends) is None
    assert clear_path(floor, some, *ends) is not None


def test_moves_have_a_direction():
    _, floor = building(room(12, 32), 1.0, 0.2)
    moves = np.array([[0, 1], [1, 2]])
    ends = floor.metres(floor.anchors[[0, 2]])
    assert clear_path(floor, moves, *ends) is not None
    assert clear_path(floor, moves[:, ::-1], *ends) is None


def test_a_shortcut_changes_places_by_its_own_moves_alone():
    world, floor = building(room(60, 60), 1.0, 0.0)
    row, column = world.cells.T
    rim = np.flatnonzero((row == 5) | (column == 0))
    moves = all_moves(world)
    on_rim = moves[np.isin(moves, rim).all(axis=1)]
    ends = floor.metres(floor.anchors[[world.state_of[0, 0], world.state_of[5, 5]]])
    around, across = clear_path(floor, on_rim, *ends, shortcuts=on_rim), clear_path(floor, on_rim, *ends)
    assert around is not None
    assert across is not None
    assert len(across) == 2
    assert len(around) > 2
    visited = {floor.state_at("path", tuple(point)) for point in around}
    assert visited <= set(rim.tolist())
    assert np.array_equal(clear_path(floor, on_rim, *ends, shortcuts=moves), across)


def test_a_path_to_the_place_itself_is_a_point():
    world, floor = building(room(22, 32), 0.5, 0.2)
    path = clear_path(floor, np.empty((0, 2), int), (1.05, 1.05), (1.05, 1.05))
    assert path is not None
    assert path.tolist() == pytest.approx(np.array([[1.05, 1.05]]))
    assert world.n_states > 1


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


@given(ends=st.lists(st.tuples(*[st.floats(0, 12)] * 2), min_size=2, max_size=2))
def test_pixels_on_a_line_are_those_of_its_samples(ends):
    a, b = np.array(ends)
    samples = np.rint(np.linspace(a, b, 2000)).astype(int)
    off_border = (np.abs(np.linspace(a, b, 2000) % 1 - 0.5) > 1e-6).all(axis=1)
    found = {tuple(pixel) for pixel in pixels_on_line(a, b).tolist()}
    assert {tuple(pixel) for pixel in samples[off_border].tolist()} <= found


@given(seed=st.integers(0, 2**32 - 1))
def test_clearance_is_the_smallest_distance_to_solid_pixels(seed):
    rng = np.random.default_rng(seed)
    state = rng.choice([FREE, OCCUPIED], size=(15, 18), p=[0.97, 0.03]).astype(np.uint8)
    solid = state != FREE
    floor = Floor(OccupancyMap(state, 0.1), np.where(solid, -1, 0).astype(np.int32), solid, 0.2, 1)
    a, b = rng.uniform(0, 14, 2), rng.uniform(0, 14, 2)
    samples = np.linspace(a, b, 4000)
    found = LineOfSight(floor).clearance(a, b)
    if solid[tuple(np.rint(samples).astype(int).T)].any():
        assert found == -1
    elif found >= 0:
        nearest = KDTree(np.argwhere(solid)).query(samples)[0].min() if solid.any() else np.inf
        assert found == pytest.approx(min(nearest, floor.radius + 1), abs=1e-4)
    else:  # only a corner that no sample falls on can be the reason
        assert np.abs(samples % 1 - 0.5).max(axis=1).min() < 0.01
