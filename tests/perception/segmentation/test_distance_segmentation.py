"""Clusters of what stands on the table: boxes put there by hand, and real scenes against their labels."""

import os
from pathlib import Path

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception import PointCloud, read_cloud, to_scene
from lifelore.perception.segmentation.distance_segmentation import euclidean_clusters
from lifelore.perception.segmentation.object_segmentation import SegmentationSettings, cut_cloud

RNG = np.random.default_rng(1)
CLUSTERS = SegmentationSettings(method="clusters")
TABLE = RNG.uniform([-0.4, -0.4, 0], [0.4, 0.4, 0.002], (4000, 3))


def box(x, y, side, height, n=3000):
    """The top and two sides of a box that stands at (x, y)."""
    points = RNG.uniform([0, 0, 0], [side, side, height], (n, 3))
    face = RNG.integers(0, 3, n)
    points[face == 0, 0], points[face == 1, 1], points[face == 2, 2] = side, side, height
    return points + np.array([x, y, 0])


def test_boxes_apart_are_objects_by_size_and_the_rest_is_table_or_nothing():
    small, large = box(0.2, 0.2, 0.05, 0.05), box(-0.2, -0.2, 0.10, 0.20, 6000)
    speck, beyond = np.array([[0.0, 0.3, 0.1]]), box(0.6, 0.0, 0.1, 0.2) + np.array([0, 0, 0.05])
    parts = [TABLE, small, large, speck, beyond]
    labels = np.split(cut_cloud(np.concatenate(parts), None, CLUSTERS).labels, np.cumsum([len(p) for p in parts]))
    assert set(labels[0]) == {1}
    assert set(labels[1][small[:, 2] > 0.01]) == {3}
    assert set(labels[2][large[:, 2] > 0.01]) == {2}
    assert set(labels[3]) == {0}
    assert set(labels[4]) == {0}  # not over the table


def test_two_things_that_touch_are_one():
    pair = np.concatenate([box(0, 0, 0.08, 0.1), box(0.08, 0, 0.08, 0.1)])
    labels = cut_cloud(np.concatenate([TABLE, pair]), None, CLUSTERS).labels
    assert set(labels[len(TABLE) :][pair[:, 2] > 0.01]) == {2}


@pytest.mark.parametrize(("gap", "expected"), [(0.006, 1), (0.030, 2)])
def test_the_tolerance_is_the_gap_that_parts(gap, expected):
    steps = np.arange(0, 0.05, 0.003)
    plate = np.stack(np.meshgrid(steps, steps, [0.1]), axis=-1).reshape(-1, 3)
    both = np.concatenate([plate, plate + np.array([steps[-1] + gap, 0, 0])])
    assert len(set(euclidean_clusters(both, 0.012, 1e-4))) == expected


def test_clusters_agree_with_single_linkage():
    from scipy.cluster.hierarchy import fcluster, linkage

    # One point a voxel (half the tolerance), so that thinning changes nothing.
    grid = np.stack(np.meshgrid(*[np.arange(7)] * 3), axis=-1).reshape(-1, 3) * 0.01
    points = grid[np.random.default_rng(2).choice(len(grid), 60, replace=False)]
    ours = euclidean_clusters(points, 0.0101, 1e-12)
    theirs = fcluster(linkage(points, "single"), 0.0101, "distance")
    assert ((ours[:, None] == ours) == (theirs[:, None] == theirs)).all()


def test_nothing_above_the_table_is_no_object():
    assert set(cut_cloud(TABLE, None, CLUSTERS).labels) == {1}
    assert len(euclidean_clusters(np.empty((0, 3)), 0.01, 1e-4)) == 0


def test_colour_needs_colours():
    with pytest.raises(InputError, match="needs colours"):
        cut_cloud(TABLE, None, SegmentationSettings(method="colour"))


@pytest.mark.parametrize("bad", [{"method": "magic"}, {"colours": 1}])
def test_settings_that_cannot_be_are_refused(bad):
    with pytest.raises(InputError, match=next(iter(bad))):
        SegmentationSettings(**bad)


@pytest.mark.skipif("LIFELORE_DATA" not in os.environ, reason="LIFELORE_DATA is not set")
def test_objects_that_stand_apart_are_found_in_a_real_scene():
    cloud = read_cloud(Path(os.environ["LIFELORE_DATA"]) / "osd" / "learn16.pcd")
    truth = cloud.labels[cloud.measured]
    scene = to_scene(PointCloud(cloud.points, camera=cloud.camera))
    for label in (2, 3, 4):
        ours = np.bincount(scene.labels[truth == label]).argmax()
        overlap = (scene.labels == ours) & (truth == label)
        assert overlap.sum() / ((scene.labels == ours) | (truth == label)).sum() > 0.9
