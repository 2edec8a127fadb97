"""Paths of policies small enough to follow by hand."""

import numpy as np
import pytest

from lifelore.agent.live.output.greedy_paths import greedy_path, greedy_paths_of, path_lengths
from lifelore.core.planning.planning import greedy_policy, optimal_q
from lifelore.domains import make_world
from lifelore.domains.grids.grid_world import GridWorld

NORTH, SOUTH, EAST, WEST = range(4)


@pytest.fixture
def corridor() -> GridWorld:
    return GridWorld.from_free("corridor", np.ones((1, 4), bool))


@pytest.mark.parametrize(
    ("policy", "path"),
    [
        ([EAST, EAST, EAST, -1], [0, 1, 2, 3]),
        ([EAST, WEST, EAST, -1], [0, 1]),  # to and fro
        ([EAST, NORTH, EAST, -1], [0, 1]),  # into the wall
        ([EAST, -1, EAST, -1], [0, 1]),  # no move known
        ([-1, -1, -1, -1], [0]),
    ],
)
def test_corridor(corridor, policy, path):
    assert greedy_path(corridor, policy, 0, 3).tolist() == path


def test_at_the_goal_the_path_is_the_goal(corridor):
    assert greedy_path(corridor, [EAST] * 4, 3, 3).tolist() == [3]


def test_lengths_in_the_corridor(corridor):
    assert path_lengths(corridor, [EAST, EAST, EAST, EAST], 3).tolist() == [3, 2, 1, 0]
    assert path_lengths(corridor, [WEST, EAST, WEST, NORTH], 2).tolist() == [-1, 1, 0, -1]


def test_lengths_agree_with_paths_under_any_policy():
    world = make_world("lattice", size=9)
    policy = np.random.default_rng(3).integers(-1, 4, world.n_states)
    lengths = path_lengths(world, policy, 7)
    for start in range(world.n_states):
        path = greedy_path(world, policy, start, 7)
        assert len(set(path.tolist())) == len(path)
        assert lengths[start] == (len(path) - 1 if path[-1] == 7 else -1)
    assert -1 in lengths


def test_ways_start_apart_and_arrive():
    world = make_world("lattice", size=9)
    policy = greedy_policy(optimal_q(world.task(0).tables(), world.discount))
    ways = greedy_paths_of(world, policy, 5, 0)
    assert (ways.task, ways.goal, ways.arriving, len(ways.paths)) == (5, 0, 1.0, 3)
    assert len({int(path[0]) for path in ways.paths}) == 3
    assert all(path[-1] == 0 for path in ways.paths)
    assert len(ways.paths[0]) - 1 == path_lengths(world, policy, 0).max()


def test_ways_where_few_or_none_arrive(corridor):
    some = greedy_paths_of(corridor, [WEST, WEST, EAST, -1], 0, 3)
    assert ([path.tolist() for path in some.paths], some.arriving) == ([[2, 3]], pytest.approx(1 / 3))
    none = greedy_paths_of(corridor, [-1] * 4, 0, 3)
    assert (none.paths, none.arriving) == ([], 0.0)


def test_a_fixed_start_is_the_only_one(corridor):
    ways = greedy_paths_of(corridor, [EAST] * 4, 0, 3, start=1)
    assert ([path.tolist() for path in ways.paths], ways.arriving) == ([[1, 2, 3]], 1.0)
