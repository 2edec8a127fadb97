"""The nearest points of two clouds against SciPy's k-d tree, ties included."""

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
    distance, own, other = by_tree(first, second)
    assert found.distance == distance
    assert (found.own == own).all()
    assert (found.other == other).all()


@pytest.mark.parametrize("sizes", [(0, 3), (3, 0), (0, 0)])
def test_an_empty_cloud_is_near_nothing(sizes):
    assert nearest_points(*(np.zeros((n, 3)) for n in sizes)) is None


places = st.lists(st.tuples(*[st.integers(-2, 2)] * 3), min_size=1, max_size=30)


@pytest.mark.slow
@settings(deadline=None)
@given(places, places)
def test_ties_are_broken_as_by_a_k_d_tree(first, second):
    agree(np.array(first) * 0.003, np.array(second) * 0.003)
