"""Poses become moves: worked by hand on a small floor, also turned and shifted."""

from dataclasses import replace

import numpy as np
import pytest

from lifelore.agent.learn_from.run_log import Run
from lifelore.agent.learn_from.tried_moves import tried_moves
from lifelore.domains.grids.grid_world import Frame, GridWorld

FREE = np.array([[1, 1, 0], [1, 1, 1]], bool)
FRAMES = [Frame(1.0), Frame(0.5, (10.0, -20.0, 0.0)), Frame(0.5, (3.0, 4.0, 2.0))]


def floor(frame: Frame) -> GridWorld:
    return GridWorld.from_free("floor", FREE, frame=frame)


def run(world: GridWorld, cells, outcome=(), heading=None) -> Run:
    """A run through points given in cells: (column, row from the bottom), 0.5 is the centre of the first cell."""
    x0, y0, yaw = world.frame.origin
    right, up = np.array(cells, float).T * world.frame.cell
    points = np.column_stack(
        [x0 + np.cos(yaw) * right - np.sin(yaw) * up, y0 + np.sin(yaw) * right + np.cos(yaw) * up]
    )
    words = [*outcome, *[""] * (len(cells) - len(outcome))]
    headings = np.full(len(cells), np.nan) if heading is None else np.array(heading) + yaw
    return Run("r", np.arange(len(cells), dtype=float), points, headings, words)


def moves(tried):
    return tried.states.tolist(), tried.actions.tolist(), tried.targets.tolist()


@pytest.fixture(params=FRAMES, ids=["plain", "shifted", "turned"])
def world(request):
    return floor(request.param)


def test_states_at_is_the_inverse_of_positions(world):
    states = np.arange(world.n_states)
    assert world.states_at(world.positions(states)).tolist() == states.tolist()
    far = world.positions(states[:1]) + np.array([100.0, 0.0])
    assert world.states_at(far).tolist() == [-1]


def test_moves_point_where_positions_lead(world):
    for action, direction in enumerate(world.move_vectors):
        state = np.flatnonzero(world.neighbour[:, action] >= 0)[:1]
        step = world.positions(world.neighbour[state, action]) - world.positions(state)
        assert np.allclose(step[0], world.frame.cell * direction)


def test_a_drive_is_a_chain_of_moves(world):
    # Bottom left, east to the middle, a long piece north, then a gap.
    tried = tried_moves(world, run(world, [(0.5, 0.5), (0.9, 0.5), (1.6, 0.5), (1.6, 1.9), (1.6, -5)]))
    left, middle, top = (world.state_of[cell] for cell in ((1, 0), (1, 1), (0, 1)))
    assert moves(tried) == ([left, middle], [2, 0], [middle, top])
    assert (tried.gaps, tried.contradictions) == (1, 0)


def test_a_hop_through_a_wall_is_not_learnt():
    # Two rows of a floor with a wall between them that is thinner than a cell.
    neighbour = np.array([[-1, -1, 1, -1], [-1, -1, -1, 0], [-1, -1, 3, -1], [-1, -1, -1, 2]], np.int32)
    world = GridWorld("thin", (2, 2), np.array([(0, 0), (0, 1), (1, 0), (1, 1)], np.int32), neighbour)
    tried = tried_moves(world, run(world, [(0.5, 0.5), (0.5, 1.5), (1.5, 1.5)]))
    assert moves(tried) == ([0], [2], [1])
    assert tried.contradictions == 1


def test_bumps_have_the_direction_of_the_heading_or_of_the_drive(world):
    top = world.state_of[0, 1]
    wall = tried_moves(world, run(world, [(1.2, 1.5), (1.9, 1.5)], ["", "bump"]))
    assert (moves(wall), wall.new_obstacles.tolist()) == (([top], [2], [top]), [False])
    chair = tried_moves(world, run(world, [(1.2, 1.5), (1.9, 1.5)], ["", "bump"], [0.0, np.pi]))
    assert (moves(chair), chair.new_obstacles.tolist()) == (([top], [3], [top]), [True])  # free to the west
    assert np.isnan(chair.seconds).all()
    unknown = tried_moves(world, run(world, [(1.5, 1.5)], ["bump"]))
    assert (len(unknown.states), unknown.undirected) == (0, 1)


def test_seconds_are_those_in_the_cell(world):
    # Poses a second apart: half a second to the first border at 1 cell/s, then 1.5 s to the next at 0.5 cell/s.
    tried = tried_moves(world, run(world, [(0.5, 0.5), (1.5, 0.5), (2.0, 0.5), (2.5, 0.5)]))
    assert np.allclose(tried.time, [0.5, 2.0], atol=0.05)
    assert np.allclose(tried.seconds, [1.0, 1.5], atol=0.1)  # the first is the time of a cell at that speed


@pytest.mark.parametrize("angle", [0.0, 0.2, np.pi / 6, np.pi / 4])
def test_seconds_are_those_of_a_straight_move_at_the_speed_of_the_drive(angle):
    """Half a cell a second, at any angle and along a border: each move that has a time has that of two seconds."""
    world = GridWorld.from_free("hall", np.ones((30, 30), bool), frame=Frame(0.5, (1.0, 2.0, 0.5)))
    along = np.arange(1, 20, 0.05)
    noise = np.random.default_rng(0).normal(0, 0.02, len(along))  # across the drive, in cells
    path = np.column_stack(
        [3 + along * np.cos(angle) - noise * np.sin(angle), 3 + along * np.sin(angle) + noise * np.cos(angle)]
    )
    drive = run(world, path)
    tried = tried_moves(world, replace(drive, time=(along - 1) / 0.5), noise=0.01)
    timed = tried.seconds[~np.isnan(tried.seconds)][1:]  # the first is of a single pair of poses
    # Both ends of a piece are some 0.02 cells off, and the piece is at least half a cell long.
    assert np.abs(timed - 2.0).max() < 0.25
    assert len(timed) >= 9  # a time for every other cell of 19


def test_poses_that_tremble_across_a_border_are_no_moves(world):
    left, middle, right = (world.state_of[1, column] for column in range(3))
    path = [(0.5, 0.5), (1.08, 0.5), (0.95, 0.5), (1.05, 0.5), (0.94, 0.5), (1.5, 0.5), (2.5, 0.5)]
    tried = tried_moves(world, run(world, path), noise=0.05 * world.frame.cell)
    assert moves(tried) == ([left, middle], [2, 2], [middle, right])
    back = tried_moves(world, run(world, [(0.5, 0.5), (1.4, 0.5), (0.5, 0.5)]), noise=0.05 * world.frame.cell)
    assert moves(back) == ([left, middle], [2, 3], [middle, left])
