"""The nearest points of two clouds: by hand, and against SciPy's k-d tree bit by bit, ties included."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import KDTree

from lifelore.perception.clouds.nearest_points import nearest_points


def by_tree(first, second):
    distances, partners = KDTree(second).query(first)
    row = int(np.argmin(distances))
    return distances[row], first[row], second[partners[row]]


def agree(first, second):
    found = nearest_points(first, second)
    assert found is not None
    distance, own, other = by_tree(first, second)
    assert found.distance == distance
    assert (found.own == own).all()
    assert (found.other == other).all()


def test_two_points_of_two_clouds():
    found = nearest_points(np.array([[0, 0, 0], [1, 0, 0]], float), np.array([[1, 0, 2], [5, 0, 0]], float))
    assert found is not None
    assert (found.distance, found.own.tolist(), found.other.tolist()) == (2.0, [1, 0, 0], [1, 0, 2])


@pytest.mark.parametrize("sizes", [(0, 3), (3, 0), (0, 0)])
def test_an_empty_cloud_is_near_nothing(sizes):
    assert nearest_points(*(np.zeros((n, 3)) for n in sizes)) is None


places = st.lists(st.tuples(*[st.integers(-2, 2)] * 3), min_size=1, max_size=30)


@pytest.mark.slow
@settings(deadline=None)
@given(places, places)
def test_ties_are_broken_as_by_a_k_d_tree(first, second):
    agree(np.array(first) * 0.003, np.array(second) * 0.003)


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 80), st.integers(1, 80))
def test_scattered_clouds_agree_with_a_k_d_tree(seed, n, m):
    rng = np.random.default_rng(seed)
    agree(rng.normal(0, 0.1, (n, 3)), rng.normal(0, 0.1, (m, 3)) + rng.normal(0, 0.1, 3))
