"""Estimated costs: against Dijkstra's algorithm of SciPy over moves written out, and paths at any angle."""

from itertools import pairwise, product

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.domains import OccupancyMap, building_from_map, floor_of, office_map
from lifelore.domains.buildings.clear_path import clear_path
from lifelore.domains.buildings.cost_ahead import cost_ahead, cost_ahead_of
from lifelore.domains.buildings.line_of_sight import ground_of, line_cost
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED

NORTH, SOUTH, EAST, WEST = range(4)
ROUTES = [
    *((move,) for move in range(4)),
    *(turn for turn in product(range(4), repeat=2) if turn[0] // 2 != turn[1] // 2),
    *((a, b, a) for a, b in product(range(4), repeat=2) if a // 2 != b // 2),
]
"""Four straight moves, eight around a corner, eight as the knight."""


def costs_of_all_routes(neighbour: np.ndarray, price: np.ndarray, middle: np.ndarray, goal: int) -> np.ndarray:
    weight = np.full((len(neighbour),) * 2, np.inf)
    for state, route in product(range(len(neighbour)), ROUTES):
        there, priced = state, 0.0
        for move in route:
            if there >= 0:
                priced += price[there, move]
                there = neighbour[there, move]
        if there >= 0:
            weight[state, there] = min(weight[state, there], priced + np.hypot(*(middle[there] - middle[state])))
    edges = np.nonzero(np.isfinite(weight))
    graph = sparse.csr_array((weight[edges], edges), shape=weight.shape)
    return csgraph.dijkstra(graph.T, indices=goal)


@pytest.mark.parametrize("seed", range(3))
def test_costs_of_cells_are_those_over_all_moves_written_out(seed):
    world = building_from_map(occupancy := office_map(seed, width_m=16.0, height_m=12.0), 1.0, 0.2)
    floor, rng = floor_of(occupancy, world), np.random.default_rng(seed)
    price = rng.exponential(5.0, (world.n_states, 4))
    price[rng.random(price.shape) < 0.2] = np.inf
    goal = int(rng.integers(world.n_states))
    ahead = cost_ahead_of(floor, price, floor.anchors[goal].astype(float))
    assert np.array_equal(ahead.middle[goal], floor.anchors[goal])
    assert ahead.cost == pytest.approx(costs_of_all_routes(floor.neighbour, price, ahead.middle, goal), rel=1e-9)


def test_on_open_floor_without_prices_the_estimate_is_at_most_three_percent_above_the_distance():
    state = np.zeros((102, 102), np.uint8)
    state[[0, -1]] = state[:, [0, -1]] = OCCUPIED
    world = building_from_map(occupancy := OccupancyMap(state, 0.1), 0.5, 0.0)
    floor, goal = floor_of(occupancy, world), np.array([52.3, 48.6])
    ahead = cost_ahead_of(floor, np.zeros((world.n_states, 4)), goal)
    for point in np.random.default_rng(0).uniform(3, 98, (200, 2)):
        away = np.hypot(*(goal - point))
        estimate = cost_ahead(ahead, floor.state[tuple(np.rint(point).astype(int))], *point)
        # Half a pixel is lost at each end, on the way to the middle of a cell of five pixels.
        assert away - 1e-9 <= estimate < 1.028 * away + 1


@pytest.mark.parametrize(("seed", "price"), [(0, 0.2), (1, 0.2), (2, 0.2), (3, 0.0), (4, 0.0)])
def test_paths_cost_at_most_three_percent_more_than_the_cheapest_over_all_pairs_of_pixels(seed, price):
    state = np.zeros((20, 20), np.uint8)
    state[[0, -1]] = state[:, [0, -1]] = OCCUPIED
    state[6:8, 4:15] = state[12, 8:17] = OCCUPIED if seed > 1 else FREE
    world = building_from_map(occupancy := OccupancyMap(state, 0.1), 0.3, 0.0)
    floor = floor_of(occupancy, world)
    ground = ground_of(floor, np.random.default_rng(seed).exponential(price, (world.n_states, 4)))
    free = np.argwhere((floor.state >= 0) & (floor.distance >= ground.wanted)).astype(float)
    length = np.array([[line_cost(ground, a[0], a[1], b[0], b[1]) for b in free.tolist()] for a in free.tolist()])
    for start, goal in ((0, -1), (17, -18), (9, -5)):
        least = csgraph.dijkstra(sparse.csr_array(length), indices=start)[goal]
        path = clear_path(floor, *floor.metres(free[[start, goal]]), ground.price * 0.1)
        corners = floor.pixels(path)
        cost = sum(line_cost(ground, a[0], a[1], b[0], b[1]) for a, b in pairwise(corners.tolist()))
        assert cost <= 1.03 * least
