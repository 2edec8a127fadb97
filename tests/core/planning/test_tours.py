"""Distances, closed tours and search orders: against SciPy, by hand, and against all orders of few places."""

from itertools import permutations

import numpy as np
import pytest
from scipy.sparse import csgraph

from lifelore.core.planning.closed_tour import closed_tour, nearest_walk
from lifelore.core.planning.near_distances import (
    BEYOND,
    NearDistances,
    known_neighbours,
    near_distances,
    steps_between,
)
from lifelore.core.planning.search_order import arrival_times, search_order

MOVES = ((-1, 0), (1, 0), (0, -1), (0, 1))


def grid(free) -> tuple[np.ndarray, np.ndarray]:
    """Where the four moves lead, and the cells, of the free cells of a plan."""
    free = np.asarray(free, bool)
    cells = np.argwhere(free)
    number = {tuple(cell): i for i, cell in enumerate(cells.tolist())}
    target = [
        [number.get((row + down, column + right), i) for down, right in MOVES]
        for i, (row, column) in enumerate(cells.tolist())
    ]
    return np.array(target, np.int32), cells


def rooms(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """The largest connected region of a plan with a quarter of its cells blocked."""
    target, cells = grid(np.random.default_rng(seed).random((14, 14)) < 0.75)
    _, region = csgraph.connected_components(known_neighbours(target), directed=False)
    inside = np.zeros((14, 14), bool)
    inside[tuple(cells[region == np.bincount(region).argmax()].T)] = True
    return grid(inside)


def walk_of(target) -> np.ndarray:
    n = len(target)
    graph = known_neighbours(target)
    begin, ends = graph.indptr.astype(np.int32), graph.indices.astype(np.int32)
    return nearest_walk(0, begin, ends, np.zeros(n, np.bool_), n)


def closed_length(near: NearDistances, tour: np.ndarray) -> int:
    """Steps of a closed tour."""
    return int(sum(steps_between(a, b, near) for a, b in zip(tour, np.roll(tour, -1), strict=True)))


@pytest.mark.parametrize("seed", range(3))
def test_distances_are_those_of_scipy(seed):
    target, cells = rooms(seed)
    graph = known_neighbours(target)
    near, exact = near_distances(graph, cells), csgraph.shortest_path(graph, unweighted=True)
    found = [[steps_between(a, b, near) for b in range(len(cells))] for a in range(len(cells))]
    assert np.array_equal(found, exact)
    for state, nearest in enumerate(near.nearest):
        assert np.array_equal(exact[state, nearest], np.sort(exact[state])[1 : len(nearest) + 1])


def test_a_move_known_one_way_counts_both_ways_and_far_places_are_estimated():
    target = np.array([[0, 1], [1, -1], [2, 2]], np.int32)
    graph = known_neighbours(target)
    assert graph.toarray().astype(bool).tolist() == [[0, 1, 0], [1, 0, 0], [0, 0, 0]]
    steps = np.full((3, 3, 3), BEYOND, np.int16)
    near = NearDistances(np.array([[0, 0], [0, 1], [4, 4]], np.int32), steps, np.full((3, 1), -1, np.int32))
    # Outside the window one and a half times 8 and 7; inside without a path a step more than around the window.
    assert [steps_between(0, 2, near), steps_between(2, 1, near)] == [12, 10]
    assert steps_between(0, 1, near) == steps_between(1, 0, near) == 3


@pytest.mark.parametrize("seed", range(4))
def test_a_closed_tour_has_every_place_once_and_is_shorter_than_the_walk(seed):
    target, cells = rooms(seed)
    near, walk = near_distances(known_neighbours(target), cells), walk_of(target)
    tour = closed_tour(near, walk)
    assert np.array_equal(np.sort(tour), np.arange(len(cells)))
    assert len(cells) <= closed_length(near, tour) < closed_length(near, walk)


@pytest.mark.parametrize("seed", range(6))
def test_the_search_order_against_all_orders(seed):
    target, cells = rooms(seed)
    near = near_distances(known_neighbours(target), cells)
    tour, random = closed_tour(near, walk_of(target)), np.random.default_rng(seed)
    start, *places = random.choice(len(cells), 7, replace=False).tolist()
    wanted = np.isin(np.arange(len(cells)), places)
    nearest = min(places, key=lambda place: steps_between(start, place, near))
    order = search_order(near, tour, wanted, start, nearest)
    assert sorted(order.tolist()) == sorted(places)

    def mean_time(way) -> float:
        return arrival_times(np.array([start, *way], np.int32), near).mean()

    least = min(mean_time(way) for way in permutations(places))
    # Local search ends in a local optimum; of these six draws, none is a tenth above the least.
    assert least <= mean_time(order) <= 1.1 * least
