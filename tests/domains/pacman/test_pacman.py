"""Pacman's maze, ghosts, sight and moves, by hand; the learners' rows and the exact values against rollouts."""

import numpy as np
import pytest

from lifelore.core import COLLISION, TERMINAL, InputError
from lifelore.domains.pacman.pacman import MAX_STEPS, STRATEGIES, PacmanMaze, PacmanTask, step
from reproduction.chapter4.c4_04_pacman.pacman_library import Arena, return_moments

NORTH, SOUTH, EAST, WEST = range(4)
SMALL = PacmanMaze(5, 5)
#  0  1  2  3  4
#  5           6
#  7  8  9 10 11     the centre is 9
# 12          13
# 14 15 16 17 18
FOODS = (0, 4, 8, 18)
EVERY = pytest.mark.parametrize("strategy", STRATEGIES)


def state_of(task, own, phase, left=0b1111):
    return (left * task.n_phases + phase) * task.maze.n_cells + own


def moved(task, own, phase, action, left=0b1111, u=0.0):
    """Own cell, phase, foods left, reward and event after one move."""
    s2, reward, event = step.py_func(task.params, state_of(task, own, phase, left), action, u)
    rest = s2 // task.maze.n_cells
    return s2 % task.maze.n_cells, rest % task.n_phases, rest // task.n_phases, reward, event


def test_the_maze_is_a_figure_eight():
    assert (SMALL.n_cells, SMALL.centre) == (19, 9)
    # Two corridors meet at two cells of three neighbours, the ends of the middle row; all others have two.
    degrees = (SMALL.grid.neighbour >= 0).sum(axis=1)
    assert np.flatnonzero(degrees == 3).tolist() == [7, 11]
    assert (np.delete(degrees, [7, 11]) == 2).all()
    assert SMALL.rim.tolist() == [0, 1, 2, 3, 4, 6, 11, 13, 18, 17, 16, 15, 14, 12, 7, 5]


def test_sight_ends_at_walls():
    assert np.flatnonzero(SMALL.sees[9]).tolist() == [7, 8, 9, 10, 11]
    assert np.flatnonzero(SMALL.sees[0]).tolist() == [0, 1, 2, 3, 4, 5, 7, 12, 14]
    # 2, 9 and 16 share a column with walls between.
    assert not SMALL.sees[2, 9]
    assert not SMALL.sees[2, 16]
    assert (SMALL.sees == SMALL.sees.T).all()


def test_ghosts_move_as_their_strategies_say():
    paths = {}
    for strategy in STRATEGIES[:3]:
        _, _, cells, following, outcome_cum = PacmanTask(SMALL, FOODS, strategy).params
        assert outcome_cum.tolist() == [1.0]
        phase, path = 0, []
        for _ in range(9):
            path.append(int(cells[phase]))
            phase = following[phase, 0]
        paths[strategy] = path
    assert paths["top row"] == [0, 1, 2, 3, 4, 3, 2, 1, 0]
    assert paths["clockwise"] == [0, 1, 2, 3, 4, 6, 11, 13, 18]
    assert paths["anticlockwise"] == [5, 7, 12, 14, 15, 16, 17, 18, 13]


def test_moves_foods_and_ends_by_hand():
    task = PacmanTask(SMALL, FOODS, "clockwise")  # phases 0.. at cells 0 1 2 3 4 6 11 13 18 ...
    assert moved(task, 9, 0, EAST) == (10, 1, 0b1111, 0.0, 0)
    assert moved(task, 9, 0, NORTH) == (9, 1, 0b1111, 0.0, COLLISION)
    assert moved(task, 9, 0, WEST) == (8, 1, 0b1011, 10.0, 0)
    # The third food was the last one left: 10 and 100.
    assert moved(task, 9, 0, WEST, left=0b0100) == (8, 1, 0, 110.0, TERMINAL)
    # Food that is gone brings nothing.
    assert moved(task, 9, 0, WEST, left=0b1011) == (8, 1, 0b1011, 0.0, 0)


@EVERY
def test_episodes_start_in_the_centre_with_the_ghost_elsewhere(strategy):
    task = PacmanTask(SMALL, FOODS, strategy)
    own, ghost, left = task.parts(task.starts)
    assert (own == 9).all()
    assert (ghost != 9).all()
    assert (left == 0b1111).all()
    assert len(task.starts) == {"top row": 8, "clockwise": 16, "anticlockwise": 16, "random": 18}[strategy]


@EVERY
def test_an_observation_tells_own_cell_foods_and_a_ghost_in_sight_and_nothing_else(strategy):
    task = PacmanTask(SMALL, FOODS, strategy)
    own, ghost, left = task.parts(np.arange(task.n_states))
    seen = np.where(SMALL.sees[own, ghost], ghost, -1)
    told = np.unique(np.column_stack([task.observation_of, own, left, seen]), axis=0)
    # One number for each triple, and one triple for each number.
    assert len(np.unique(told[:, 0])) == len(told) == len(np.unique(told[:, 1:], axis=0))
    assert task.observation_of.max() < task.n_observations == 16 * 19 * 20


@EVERY
def test_tables_are_the_step_enumerated(strategy):
    task = PacmanTask(SMALL, FOODS, strategy)
    tables = task.tables()
    generator = np.random.default_rng(4)
    for _ in range(3000):
        s = int(generator.integers(task.n_states // 16, task.n_states))
        a, u = int(generator.integers(4)), float(generator.random())
        k = int(np.searchsorted(tables.outcome_cum, u, side="right"))
        row = tables.next_state[s, a, k], tables.reward[s, a, k], tables.event[s, a, k]
        assert row == step(task.params, s, a, u) == step.py_func(task.params, s, a, u)


@EVERY
def test_exact_moments_agree_with_episodes(strategy):
    task = PacmanTask(SMALL, FOODS, strategy)
    tables = task.tables()
    probs = np.random.default_rng(1).dirichlet(np.ones(4), task.n_observations)
    mean, deviation = return_moments(tables, task.observation_of, probs, MAX_STEPS)
    n = 20_000
    (returns,) = Arena.of(task).returns_of_each(probs[None], n, (1, strategy))
    # Five standard errors; of a deviation σ it is at most about σ √(kurtosis / 4n), returns lie within 240.
    assert abs(returns.mean() - mean) < 5 * deviation / np.sqrt(n)
    assert abs(returns.std() - deviation) < 5 * 240 / np.sqrt(4 * n)


def test_a_walk_known_by_hand():
    # East for ever from the centre: food at 10 at once, then at 11, and the clockwise ghost is met there
    # if it stands on the rim's cell 11, or comes; over 16 phases it passes 11 within 16 steps of waiting.
    task = PacmanTask(SMALL, (10, 11, 0, 14), "clockwise")
    east = np.tile([0.0, 0.0, 1.0, 0.0], (task.n_observations, 1))
    # Cell 11 is phase 6. Pacman arrives at step 2 and is met there at once from phase 4, before it eats; from any
    # other it eats both, and is met later.
    expected = (1 * (10 - 100) + 15 * (20 - 100)) / 16
    assert return_moments(task.tables(), task.observation_of, east, 200)[0] == pytest.approx(expected)
    # Cut after two steps, only one of 16 is lost.
    assert return_moments(task.tables(), task.observation_of, east, 2)[0] == pytest.approx((-90 + 15 * 20) / 16)


@pytest.mark.parametrize(("rows", "columns", "name"), [(4, 5, "rows"), (3, 5, "rows"), (5, 2, "columns")])
def test_mazes_that_are_no_figure_eight(rows, columns, name):
    with pytest.raises(InputError, match=f"{name} must be odd"):
        PacmanMaze(rows, columns)


@pytest.mark.parametrize("foods", [(0, 1, 2), (0, 0, 1, 2), (0, 1, 2, 9), (0, 1, 2, 19), (0, 1, 2, -1)])
def test_foods_that_cannot_be(foods):
    with pytest.raises(InputError, match="foods must be 4 different cells"):
        PacmanTask(SMALL, foods, "random")
