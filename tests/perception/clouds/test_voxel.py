"""Voxels against a plain dictionary, and clouds too large to keep whole."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core import InputError, LabelledCloud
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.clouds.voxel import thinned, voxelised, voxels_of


def by_dictionary(points, labels, size):
    """Members of each voxel and label, in the order of their first member."""
    low = np.floor(points.min(axis=0) / size) * size
    members = {}
    for i, (point, label) in enumerate(zip(points, labels, strict=True)):
        members.setdefault((int(label), *np.floor((point - low) * (1 / size)).astype(int).tolist()), []).append(i)
    return list(members.values())


@settings(deadline=None, max_examples=40)
@given(
    st.integers(0, 10**6), st.integers(1, 60), st.sampled_from([0.003, 0.05, 1.0]), st.sampled_from([1, 3, 10**12])
)
def test_the_same_voxels_as_a_dictionary(seed, n, size, top_label):
    rng = np.random.default_rng(seed)
    points, labels = rng.uniform(-0.1, 0.1, (n, 3)), rng.integers(0, top_label + 1, n)
    found, thin = voxels_of(points, size, labels), voxelised(LabelledCloud(points, labels), size)
    groups = by_dictionary(points, labels, size)
    assert [np.flatnonzero(found.inverse == v).tolist() for v in range(len(found.counts))] == groups
    assert found.first.tolist() == [group[0] for group in groups]
    assert found.counts.tolist() == [len(group) for group in groups]
    assert thin.labels.tolist() == [labels[group[0]] for group in groups]
    np.testing.assert_allclose(thin.points, [points[group].mean(axis=0) for group in groups], atol=1e-15)


def test_cubes_stand_on_multiples_of_the_size_whatever_else_is_there():
    pair = np.array([[0.0031, 0.001, 0.001], [0.0059, 0.001, 0.001]])
    for extra in (np.empty((0, 3)), np.array([[-0.0004, 0.0, 0.0]])):
        assert voxels_of(np.concatenate([pair, extra]), 0.003).inverse[:2].tolist() == [0, 0]


def test_colour_and_camera_come_along():
    colours = np.array([[1, 2, 3], [4, 5, 6]], np.uint8)
    cloud = LabelledCloud(np.zeros((2, 3)), np.array([2, 2]), colours, np.ones(3))
    thin = voxelised(cloud)
    assert thin.colours.tolist() == [[1, 2, 3]]
    assert thin.camera is cloud.camera


def test_an_empty_cloud_has_no_voxels():
    thin = voxelised(LabelledCloud(np.empty((0, 3)), np.empty(0, np.int64)))
    assert len(thin.points) == len(thin.labels) == 0


@pytest.mark.parametrize("size", [0.0, -1.0, np.nan, np.inf, 1e-12])
def test_a_size_that_cannot_be_is_refused(size):
    cloud = LabelledCloud(np.array([[0.0, 0, 0], [1, 1, 1]]), np.array([1, 1]))
    with pytest.raises(InputError, match="size"):
        voxelised(cloud, size)


def test_a_cloud_that_is_small_enough_is_left_alone():
    cloud = PointCloud(np.zeros((5, 3)))
    assert thinned(cloud, at_most=5) is cloud


def test_a_large_cloud_is_thinned():
    rng = np.random.default_rng(2)
    points, labels = rng.uniform(0, 0.02, (300, 3)), rng.integers(0, 3, 300)
    points[5] = np.nan
    colours = rng.integers(0, 256, (300, 3)).astype(np.uint8)
    thin = thinned(PointCloud(points, labels, colours), size=0.01, at_most=250)
    kept = ~np.isnan(points[:, 0])
    groups = by_dictionary(points[kept], labels[kept], 0.01)
    np.testing.assert_allclose(thin.points, [points[kept][group].mean(axis=0) for group in groups], atol=1e-12)
    assert thin.labels.tolist() == [labels[kept][group[0]] for group in groups]
    assert thin.colours.tolist() == [colours[kept][group[0]].tolist() for group in groups]


def test_voxels_grow_until_they_are_few_enough():
    rng = np.random.default_rng(3)
    thin = thinned(PointCloud(rng.uniform(0, 1, (5000, 3)).astype(np.float32)), size=0.003, at_most=100)
    assert 8 <= len(thin.points) <= 100
    assert thin.points.dtype == np.float32
