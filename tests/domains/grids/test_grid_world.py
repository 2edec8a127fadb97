"""Grid worlds: one small floor in every detail."""

import numpy as np
import pytest

from lifelore.core import COLLISION, NOTHING, TERMINAL, InputError
from lifelore.domains.grids.grid_world import Frame, GridWorld, step

#   0 1        the cell right of 2 is a wall
#   2
FLOOR = np.array([[True, True], [True, False]])


def test_states_moves_and_percepts_by_hand():
    world = GridWorld.from_free("test", FLOOR)
    assert world.cells.tolist() == [[0, 0], [0, 1], [1, 0]]
    assert world.neighbour.tolist() == [[-1, 2, 1, -1], [-1, -1, -1, 0], [0, -1, -1, -1]]
    # Bits from the right: N S E W move, then NE NW SE SW occupied; outside counts as occupied.
    assert world.percepts.tolist() == [0b1111_0110, 0b0111_1000, 0b1110_0001]


def test_step_and_tables_by_hand():
    task = GridWorld.from_free("test", FLOOR).task(goal=1)
    assert step(task.params, 0, 0, 0.0) == (0, -10.0, COLLISION)
    assert step(task.params, 0, 1, 0.0) == (2, 0.0, NOTHING)
    assert step(task.params, 0, 2, 0.0) == (1, 100.0, TERMINAL)
    tables = task.tables()
    assert tables.next_state[0, :, 0].tolist() == [0, 2, 1, 0]
    assert tables.reward[0, :, 0].tolist() == [-10.0, 0.0, 100.0, -10.0]
    assert tables.event[0, :, 0].tolist() == [COLLISION, NOTHING, TERMINAL, COLLISION]
    assert tables.starts.tolist() == [0, 2]


def test_positions_by_hand():
    world = GridWorld.from_free("test", FLOOR, frame=Frame(2.0, (10.0, 20.0, 0.0)))
    assert world.positions(np.array([0, 1, 2])).tolist() == [[11.0, 23.0], [13.0, 23.0], [11.0, 21.0]]


def test_the_fingerprint_knows_what_makes_a_world():
    worlds = [
        GridWorld.from_free("test", FLOOR),
        GridWorld.from_free("other", FLOOR),
        GridWorld.from_free("test", FLOOR[::-1]),
        GridWorld.from_free("test", FLOOR, frame=Frame(2.0)),
        GridWorld.from_free("test", FLOOR, about={"robot_radius": 0.3}),
    ]
    assert len({world.fingerprint for world in worlds}) == len(worlds)
    # Rewards and discount belong to the task, not to what is learnt of the moves.
    assert GridWorld.from_free("test", FLOOR, goal_reward=1.0).fingerprint == worlds[0].fingerprint


def test_broken_rules():
    with pytest.raises(InputError, match="at least 2 cells, got 1"):
        GridWorld.from_free("test", np.array([[True]]))
    with pytest.raises(InputError, match="discount"):
        GridWorld.from_free("test", FLOOR, discount=1.0)
    with pytest.raises(InputError, match="wall_reward must be a finite number"):
        GridWorld.from_free("test", FLOOR, wall_reward=float("nan"))
    with pytest.raises(InputError, match=r"goal must be a state in \[0, 3\), got 3"):
        GridWorld.from_free("test", FLOOR).task(3)


@pytest.mark.parametrize("chosen", [[], [7], [0, 7, 23]])
def test_states_around_others(chosen):
    world = GridWorld.from_free("test", np.random.default_rng(1).random((6, 7)) < 0.8)
    near = [any(np.abs(cell - world.cells[one]).max() <= 1 for one in chosen) for cell in world.cells]
    mask = np.isin(np.arange(world.n_states), chosen)
    assert world.around(np.array(chosen, np.int64)).tolist() == world.around(mask).tolist() == near
