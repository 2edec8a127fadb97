"""Noise mazes: the exact number of obstacles, always connected, nothing kept that could be walled up."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from lifelore.core.errors import InputError
from lifelore.domains.grids.noise_maze import _can_spare, noise_maze


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.integers(4, 15), st.floats(0, 0.99))
def test_count_and_connectedness(seed, size, density):
    inside = (size - 2) ** 2
    if round(density * inside) > inside - 2:
        with pytest.raises(InputError, match="obstacles must lie in"):
            noise_maze(np.random.default_rng(seed), size, density)
        return
    world = noise_maze(np.random.default_rng(seed), size, density)
    free = world.state_of >= 0
    assert free.sum() == inside - round(density * inside)
    assert ndimage.label(free)[1] == 1
    assert not free[[0, -1]].any()
    assert not free[:, [0, -1]].any()


@pytest.mark.parametrize("seed", range(20))
def test_a_cell_is_spared_exactly_when_the_rest_stays_connected(seed):
    rng = np.random.default_rng(seed)
    free = noise_maze(rng, 9, float(rng.uniform(0, 0.8))).state_of >= 0
    for row, column in np.argwhere(free):
        without = free.copy()
        without[row, column] = False
        connected = ndimage.label(without)[1] == 1
        stack, seen = np.zeros((2, free.size), np.int64)
        assert _can_spare(free.ravel(), row * 9 + column, 9, stack, seen, 1) == connected


@pytest.mark.slow
def test_the_thesis_range_and_defaults():
    worlds = [noise_maze(np.random.default_rng(seed)) for seed in range(20)]
    shares = np.array([1 - world.n_states / 441 for world in worlds])
    assert ((shares > 0.498) & (shares < 0.802)).all()
    # Uniform on [.5, .8]: the mean of 20 has a standard error of .0194; 4 of them.
    assert abs(shares.mean() - 0.65) < 0.078
    assert (worlds[0].discount, worlds[0].goal_reward, worlds[0].wall_reward) == (0.95, 100.0, -10.0)


@pytest.mark.parametrize(
    ("key", "values", "words"),
    [
        ("size", (3, 10**6), "size of a noise maze"),
        ("density", (1.0, -0.1, float("nan")), "density must lie in"),
        ("obstacles", (-1, 440), "obstacles must lie in"),
    ],
)
def test_each_broken_rule_is_one_clear_line(key, values, words):
    for value in values:
        with pytest.raises(InputError, match=words):
            noise_maze(np.random.default_rng(0), **{key: value})
    with pytest.raises(InputError, match="not both"):
        noise_maze(np.random.default_rng(0), density=0.5, obstacles=3)
