"""Exports lie where the world lies: origin and yaw of the map, read back by our own reader."""

import math

import numpy as np
import pytest

from lifelore.agent.live.output.exports import NO_PRIOR, decided_percent, path_points, write_paths, write_prior_map
from lifelore.agent.live.output.greedy_paths import GreedyPaths
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, UNKNOWN, read_occupancy_map
from lifelore.domains.grids.grid_world import Frame, GridWorld

PROBS = np.array([[0.25] * 4, [1.0, 0, 0, 0], [0.5, 0.5, 0, 0], [1.0, 0, 0, 0]])
COUNTED = np.array([True, True, True, False])


@pytest.fixture
def corridor() -> GridWorld:
    """Four cells of half a metre, the map turned a quarter to the left about (10, 20)."""
    frame = Frame(0.5, (10.0, 20.0, math.pi / 2))
    return GridWorld.from_free("corridor", np.ones((1, 4), bool), frame=frame)


def test_paths_are_in_metres_of_the_turned_map(corridor, tmp_path):
    write_paths(tmp_path / "paths.csv", {6: path_points(corridor, GreedyPaths(6, 3, [np.array([1, 2, 3])], 1.0))})
    assert (tmp_path / "paths.csv").read_text(encoding="utf-8").splitlines() == [
        "task,path,step,x,y",
        "6,0,0,9.7500,20.7500",
        "6,0,1,9.7500,21.2500",
        "6,0,2,9.7500,21.7500",
    ]


def test_percent_of_decision(corridor):
    assert decided_percent(corridor, PROBS, COUNTED).tolist() == [[0, 100, 50, NO_PRIOR]]


def test_what_is_no_floor_has_no_prior():
    world = GridWorld.from_free("pair", np.array([[True, True], [False, False]]))
    assert decided_percent(world, PROBS[:2], COUNTED[:2]).tolist() == [[0, 100], [NO_PRIOR, NO_PRIOR]]


def test_prior_map_round_trip_with_yaw(corridor, tmp_path):
    write_prior_map(tmp_path / "prior.yaml", corridor, PROBS, COUNTED)
    read = read_occupancy_map(tmp_path / "prior.yaml")
    assert read.state.tolist() == [[FREE, OCCUPIED, UNKNOWN, UNKNOWN]]
    assert (read.resolution, read.origin) == (0.5, corridor.frame.origin)
    assert (tmp_path / "prior.pgm").read_bytes() == b"P5\n4 1\n255\n" + bytes([0, 100, 50, 255])
    assert (tmp_path / "prior.yaml").read_text(encoding="utf-8").startswith("# How decided")
