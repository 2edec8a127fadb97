"""Normals of surfaces: the naive twin, and what spans no plane."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from lifelore.perception.clouds.surface_normals import surface_normals


def naive(points, pairs):
    """The eigenvector of the least eigenvalue of each point and its neighbours."""
    found = []
    for i in range(len(points)):
        near = points[[i, *pairs[pairs[:, 0] == i, 1], *pairs[pairs[:, 1] == i, 0]]]
        away = near - near.mean(axis=0)
        found.append(np.linalg.eigh(away.T @ away)[1][:, 0])
    return np.array(found)


@pytest.mark.parametrize("shift", [0.0, 50.0])
def test_same_as_the_eigenvectors_of_each_neighbourhood(shift):
    x, y = np.random.default_rng(0).uniform(0, 0.2, (2, 400))
    points = np.column_stack([x, y, 0.05 * np.sin(20 * x)]) + shift
    pairs = KDTree(points).query_pairs(0.04, output_type="ndarray")
    cosine = np.einsum("ij,ij->i", surface_normals(points, pairs), naive(points, pairs))
    assert np.abs(cosine) == pytest.approx(np.ones(400), abs=1e-9)


def test_on_a_line_the_normal_is_across_it_and_a_point_alone_faces_up():
    for axis in ([1.0, 2.0, 3.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]):
        line = np.outer(np.arange(10.0), axis)
        normals = surface_normals(line, np.array([(i, j) for i in range(10) for j in range(i)]))
        assert normals @ axis == pytest.approx(np.zeros(10), abs=1e-9)
        assert np.linalg.norm(normals, axis=1) == pytest.approx(np.ones(10))
    assert surface_normals(np.zeros((1, 3)), np.empty((0, 2), np.int64)).tolist() == [[0, 0, 1]]
