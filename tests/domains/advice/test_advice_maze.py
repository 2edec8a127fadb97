"""Advice mazes: connected, a tree with as many loops as asked for, goals in corners and at corridors' ends."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from lifelore.core.errors import InputError
from lifelore.domains.advice.advice_maze import advice_maze, errand, maze_goals


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.integers(6, 24), st.floats(0, 1))
def test_connected_and_as_many_loops_as_asked(seed, size, loops):
    world = advice_maze(np.random.default_rng(seed), size, loops, n_goals=1)
    free = world.state_of >= 0
    assert free.shape == (size, size)
    assert ndimage.label(free)[1] == 1  # type: ignore[index]
    assert not free[[0, -1]].any()
    assert not free[:, [0, -1]].any()
    # A connected plane drawing of corridors has edges - cells + 1 loops; of n × n crossings a tree leaves (n - 1)²
    # of the 2n(n - 1) places between two of them closed. Doubling a line turns no corridor into a loop.
    n = (size - 1) // 2
    edges = (world.neighbour >= 0).sum() // 2
    assert edges - world.n_states + 1 == round(loops * (n - 1) ** 2)


def test_goals_lie_in_corners_and_at_ends_and_both_kinds_occur():
    kinds = set()
    for seed in range(20):
        world = advice_maze(np.random.default_rng(seed))
        for goal in maze_goals(world):
            ways = np.flatnonzero(world.neighbour[goal] >= 0).tolist()
            # North and south, or east and west, would be a corridor leading straight on.
            assert len(ways) == 1 or (len(ways) == 2 and ways not in ([0, 1], [2, 3]))
            kinds.add(len(ways))
    assert kinds == {1, 2}


def test_an_errand_starts_at_no_goal_and_pays_at_its_own():
    world = advice_maze(np.random.default_rng(1), 12, 0.5, n_goals=4)
    goal = int(maze_goals(world)[0])
    tables = errand(world, goal).tables()
    assert not np.isin(tables.starts, maze_goals(world)).any()
    assert (tables.next_state[tables.reward == 1000.0] == goal).all()
    assert errand(world, goal, np.array([3], np.int32)).tables().starts.tolist() == [3]


@pytest.mark.parametrize(
    ("key", "values", "words"),
    [
        ("size", (5, 1000), "size of an advice maze"),
        ("loops", (-0.1, float("nan")), "loops must be a share"),
        ("n_goals", (0, 9999), "n_goals must lie in"),
    ],
)
def test_each_broken_rule_is_one_clear_line(key, values, words):
    for value in values:
        with pytest.raises(InputError, match=words):
            advice_maze(np.random.default_rng(0), **{key: value})
