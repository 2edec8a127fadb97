"""Clusters against SciPy's single linkage; centroids, extents and edges worked by hand."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.cluster.hierarchy import fcluster, linkage

from lifelore.perception.contacts.contact_points import (
    closest,
    contact_clusters,
    contact_edges,
    contact_point,
    extent,
    facing_clusters,
    linked,
)


@settings(deadline=None, max_examples=60)
@given(st.integers(2, 60), st.integers(0, 2**32))
def test_components_are_those_of_single_linkage(n, seed):
    points = np.random.default_rng(seed).random((n, 3)) * 0.15
    ours = linked(points, 0.03)
    theirs = fcluster(linkage(points, "single"), 0.03, "distance")
    same = ours[:, None] == ours[None]
    np.testing.assert_array_equal(same, theirs[:, None] == theirs[None])
    assert list(dict.fromkeys(ours)) == list(range(ours.max() + 1))


def strip(x: float, n: int) -> np.ndarray:
    return np.column_stack([np.full(n, x), np.arange(n) * 0.01, np.zeros(n)])


def test_small_clusters_go_and_where_both_objects_are_clustered_the_strongest_stays():
    points = np.vstack([strip(0.0, 9), strip(0.2, 3), strip(0.4, 8)])
    alpha = np.concatenate([np.full(9, 1.0), np.full(3, 5.0), np.full(8, 1.0)])
    assert [rows.tolist() for rows in contact_clusters(points, alpha, 0.025, 7)] == [
        list(range(9)),
        list(range(12, 20)),
    ]
    assert contact_clusters(points, alpha, 0.025, 100) == []
    for side in facing_clusters(points, alpha, points, alpha, 0.025, 100):
        assert [rows.tolist() for rows in side] == [[9, 10, 11]]
    assert len(contact_clusters(points, alpha, 0.025, 1)) == 3


def test_a_contact_cut_in_two_on_one_object_is_one_where_the_other_holds_it_together():
    cut, whole, ones = (
        np.vstack([strip(0.0, 5), strip(0.0, 5) + np.array([0, 0.1, 0])]),
        strip(0.01, 15),
        np.ones(15),
    )
    assert [len(rows) for rows in contact_clusters(cut, ones[:10], 0.025, 1)] == [5, 5]
    assert [[len(rows) for rows in side] for side in facing_clusters(cut, ones[:10], whole, ones, 0.025, 1)] == [
        [10],
        [15],
    ]
    # Too far away to hold anything together, and with more in it than faces anything.
    away = np.vstack([strip(0.03, 15), strip(0.3, 15)])
    found = facing_clusters(cut, ones[:10], away, np.repeat([1.0, 2.0], 15), 0.025, 1)
    assert [rows.tolist() for rows in found[0]] == [list(range(5)), list(range(5, 10))]
    assert [rows.tolist() for rows in found[1]] == [list(range(15, 30)), list(range(15))]


def test_a_contact_has_the_extent_and_strength_of_its_support_vectors():
    points = np.array([[0.0, 0, 0], [0.03, 0, 0], [0.0, 0.01, 0]])
    one = contact_point(points[0], points, np.array([1.0, 2.0, 1.0]), np.array([0.0, 0, 1]), 7)
    assert (one.strength, one.n_support, one.other) == (4.0, 3, 7)
    assert np.isclose(one.extent[2], 0)


def test_extent_of_a_turned_box_is_its_sides():
    corners = np.array([[x, y, z] for x in (0, 3.0) for y in (0, 2.0) for z in (0, 1.0)])
    turn, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))
    np.testing.assert_allclose(extent(corners @ turn.T), [3, 2, 1], atol=1e-12)


def test_every_contact_faces_the_closest_of_the_other_side():
    a = [np.zeros((1, 3)), np.array([[1.0, 0, 0]])]
    b = [np.array([[0.1, 0, 0]])]
    assert contact_edges(a, b).tolist() == [[0, 0], [1, 0]]
    b.append(np.array([[1.1, 0, 0], [3, 0, 0]]))
    assert contact_edges(a, b).tolist() == [[0, 0], [1, 1]]
    assert np.isclose(closest(a[1], b[1]), 0.1)
    assert contact_edges([], b).shape == (0, 2)
