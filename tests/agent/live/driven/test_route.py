"""Routes are as short and as cheap as can be, cut no corner, and avoid what is closed."""

import networkx as nx
import numpy as np
import pytest

from lifelore.agent.live.driven.route import DIAGONAL, cheapest_route
from lifelore.domains.grids.grid_world import MOVES, GridWorld

CORNERS = ((0, 2), (0, 3), (1, 2), (1, 3))


def grid(*rows: str) -> GridWorld:
    return GridWorld.from_free("hall", np.array([[mark == "." for mark in row] for row in rows]))


def even(world: GridWorld) -> np.ndarray:
    return np.where(world.neighbour >= 0, 1.0, np.inf)


def naive_seconds(world: GridWorld, seconds: np.ndarray, start: int, goal: int) -> float:
    """The least seconds, over a graph that is built step by step."""
    graph = nx.DiGraph()
    graph.add_nodes_from(range(world.n_states))
    for state in range(world.n_states):
        for move in range(4):
            if np.isfinite(seconds[state, move]):
                graph.add_edge(state, int(world.neighbour[state, move]), weight=seconds[state, move])
        for pair in CORNERS:
            ways = []
            for first, second in (pair, pair[::-1]):
                middle = world.neighbour[state, first]
                ways.append(np.inf if middle < 0 else seconds[state, first] + seconds[middle, second])
            if np.isfinite(ways).all():
                end = int(world.neighbour[world.neighbour[state, pair[0]], pair[1]])
                graph.add_edge(state, end, weight=DIAGONAL * min(ways))
    try:
        return float(nx.dijkstra_path_length(graph, start, goal))
    except nx.NetworkXNoPath:
        return np.inf


@pytest.mark.parametrize("seed", range(8))
def test_routes_take_the_least_seconds(seed):
    rng = np.random.default_rng(seed)
    world = GridWorld.from_free("noise", rng.random((7, 9)) < 0.7)
    seconds = np.where(world.neighbour >= 0, rng.uniform(0.5, 5.0, world.neighbour.shape), np.inf)
    seconds[rng.random(seconds.shape) < 0.1] = np.inf
    start, goal = rng.choice(world.n_states, 2, replace=False).tolist()
    route = cheapest_route(world, start, goal, seconds)
    least = naive_seconds(world, seconds, start, goal)
    if route is None:
        assert least == np.inf
        return
    assert (route.states[0], route.states[-1]) == (start, goal)
    steps, actions = np.nonzero(world.neighbour[route.states[:-1]] == route.states[1:, None])
    assert steps.tolist() == list(range(len(route.lengths)))
    assert route.lengths @ seconds[route.states[:-1], actions] == pytest.approx(least)


def test_an_open_hall_is_crossed_within_a_twelfth_of_the_straight_line():
    world = GridWorld.from_free("hall", np.ones((40, 60), bool))
    rng = np.random.default_rng(0)
    for start, goal in rng.choice(world.n_states, (30, 2)).tolist():
        route = cheapest_route(world, start, goal, even(world))
        straight = np.hypot(*(world.cells[goal] - world.cells[start]))
        assert straight - 1e-9 <= route.lengths.sum() <= 1.0824 * straight + 1e-9


def test_no_corner_is_cut():
    world = grid("..", ".#")
    route = cheapest_route(world, 1, 2, even(world))
    assert route.states.tolist() == [1, 0, 2]
    assert route.lengths.tolist() == [1.0, 1.0]


def test_no_way_and_no_move():
    world = grid(".#..")
    assert cheapest_route(world, 0, 1, even(world)) is None
    route = cheapest_route(world, 1, 1, even(world))
    assert (route.states.tolist(), len(route.lengths)) == ([1], 0)


def test_steps_follow_the_order_of_moves():
    """The planner's corners are the moves of `MOVES` in pairs."""
    assert [tuple(MOVES[a] + MOVES[b]) for a, b in CORNERS] == [(-1, 1), (-1, -1), (1, 1), (1, -1)]
