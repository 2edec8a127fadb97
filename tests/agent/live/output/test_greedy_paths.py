"""Paths of policies small enough to follow by hand, and beside a walk step by step."""

import math

import numpy as np
import pytest

from lifelore.agent.live.output.greedy_paths import GreedyPaths, greedy_paths_of, path_points, write_paths
from lifelore.core.planning.planning import greedy_policy, optimal_q
from lifelore.domains import make_world
from lifelore.domains.grids.grid_world import Frame, GridWorld

NORTH, SOUTH, EAST, WEST = range(4)
CORRIDOR = GridWorld.from_free("corridor", np.ones((1, 4), bool))


def walk(world: GridWorld, policy: np.ndarray, start: int, goal: int) -> list[int]:
    """The states passed on the way to the goal; empty if it is not reached."""
    path = [start]
    while path[-1] != goal and policy[path[-1]] >= 0 and len(path) <= world.n_states:
        path.append(int(world.neighbour[path[-1], policy[path[-1]]]))
        if path[-1] < 0:
            return []
    return path if path[-1] == goal else []


@pytest.mark.parametrize(
    ("policy", "path"),
    [
        ([EAST, EAST, EAST, -1], [0, 1, 2, 3]),
        ([EAST, EAST, EAST, WEST], [0, 1, 2, 3]),
        ([EAST, WEST, EAST, -1], None),  # to and fro
        ([EAST, NORTH, EAST, -1], None),  # into the wall
        ([EAST, -1, EAST, -1], None),  # no move known
    ],
)
def test_from_one_start_through_a_corridor(policy, path):
    ways = greedy_paths_of(CORRIDOR, policy, 0, 3, start=0)
    assert [one.tolist() for one in ways.paths] == ([] if path is None else [path])
    assert ways.arriving == (path is not None)


@pytest.mark.parametrize("seed", range(3))
def test_paths_are_those_of_a_walk_under_any_policy(seed):
    world, rng = make_world("lattice", size=9), np.random.default_rng(seed)
    best = greedy_policy(optimal_q(world.task(7).tables(), world.discount))
    policy = np.where(rng.random(world.n_states) < 0.2, rng.integers(-1, 4, world.n_states), best)
    walks = [walk(world, policy, start, 7) for start in range(world.n_states) if start != 7]
    ways = greedy_paths_of(world, policy, 5, 7)
    assert (ways.task, ways.goal) == (5, 7)
    assert ways.arriving == pytest.approx(np.mean([bool(path) for path in walks]))
    assert 0 < ways.arriving < 1
    assert all(path.tolist() in walks for path in ways.paths)
    assert len(ways.paths[0]) == max(map(len, walks))
    assert len({int(path[0]) for path in ways.paths}) == min(3, sum(map(bool, walks)))


def test_ways_where_few_or_none_arrive():
    some = greedy_paths_of(CORRIDOR, [WEST, WEST, EAST, -1], 0, 3)
    assert ([path.tolist() for path in some.paths], some.arriving) == ([[2, 3]], pytest.approx(1 / 3))
    none = greedy_paths_of(CORRIDOR, [-1] * 4, 0, 3)
    assert (none.paths, none.arriving) == ([], 0.0)


def test_paths_are_written_in_metres_of_a_turned_map(tmp_path):
    """Cells of half a metre, the map turned a quarter to the left about (10, 20)."""
    turned = GridWorld.from_free("corridor", np.ones((1, 4), bool), frame=Frame(0.5, (10.0, 20.0, math.pi / 2)))
    write_paths(tmp_path / "paths.csv", {6: path_points(turned, GreedyPaths(6, 3, [np.array([1, 2, 3])], 1.0))})
    assert (tmp_path / "paths.csv").read_text(encoding="utf-8").splitlines() == [
        "task,path,step,x,y",
        "6,0,0,9.7500,20.7500",
        "6,0,1,9.7500,21.2500",
        "6,0,2,9.7500,21.7500",
    ]
