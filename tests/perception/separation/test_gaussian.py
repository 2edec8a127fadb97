"""The exponential and the plain sums beside NumPy's."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.perception.separation.gaussian import kernel_row, kernel_sums


@given(st.lists(st.floats(0, 37), min_size=1, max_size=30))
@settings(deadline=None)
def test_row_of_the_kernel_matrix(distances):
    points = np.zeros((3, len(distances) + 1))
    points[2, 1:] = distances
    row = np.empty(points.shape[1])
    kernel_row(points, 0, row)
    assert row[0] == 1.0
    assert row[1:] == pytest.approx([math.exp(-d * d / 2) for d in distances], rel=1e-13)


def test_far_away_is_as_good_as_nothing():
    row = np.empty(2)
    kernel_row(np.array([[0.0, 1e9], [0, 0], [0, 0]]), 0, row)
    assert row[0] == 1.0
    assert 0 <= row[1] < 1e-300


@pytest.mark.parametrize("n_sources", [0, 1, 2, 3, 4, 5, 101])
def test_sums_at_some_points_alone(n_sources):
    random = np.random.default_rng(n_sources)
    points, sources = random.normal(size=(3, 12)), random.normal(size=(3, n_sources))
    weights, which = random.normal(size=n_sources), np.array([1, 5, 11])
    sums = np.full(12, 7.0)
    kernel_sums(points, sources, weights, which, sums)
    expected = np.full(12, 7.0)
    for i in which:
        expected[i] = sum(
            w * math.exp(-sum((points[:, i] - source) ** 2) / 2)
            for w, source in zip(weights, sources.T, strict=True)
        )
    assert sums == pytest.approx(expected, abs=1e-12)
