"""Regions: boxes and ranges that crop a cloud, and the limit of objects."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.segmentation.object_segmentation import SegmentationSettings
from lifelore.perception.segmentation.region import Region, inside
from lifelore.perception.segmentation.table_frame import segmented_scene

POINTS = np.array([[0.0, 0, 1], [0.5, 0, 1], [0, 0, 3], [np.nan, 0, 1]])


@pytest.mark.parametrize(
    ("region", "kept"),
    [
        (Region(roi=(-1, 0.2, -1, 1, 0, 2)), [0]),
        (Region(roi=(-1, np.inf, -1, 1, 0, 5)), [0, 1, 2]),
        (Region(max_range=1.05), [0]),
        (Region(roi=(0.1, 1, -1, 1, -1, 5), max_range=2.0), [1]),
    ],
)
def test_points_in_the_box_and_the_range_are_used(region, kept):
    found = inside(PointCloud(POINTS, np.array([1, 2, 3, 0])), region)
    assert found.points.tolist() == POINTS[kept].tolist()
    assert found.labels.tolist() == (np.array(kept) + 1).tolist()


def test_the_range_is_measured_from_the_camera():
    cloud = PointCloud(POINTS, camera=np.array([0.0, 0, 3]))
    assert inside(cloud, Region(max_range=0.1)).points.tolist() == [[0, 0, 3]]


def test_without_limits_the_cloud_is_the_same():
    cloud = PointCloud(POINTS)
    assert inside(cloud, Region()) is cloud


def test_an_empty_region_says_where_the_cloud_is():
    with pytest.raises(InputError, match=r"holds no point of the cloud, which spans x 0.00 to 0.50"):
        inside(PointCloud(POINTS), Region(max_range=0.5))


@pytest.mark.parametrize(
    "bad",
    [
        {"roi": (1, 0, 0, 1, 0, 1)},
        {"roi": (0, 1, 0, 1, 0)},
        {"roi": (0, 1, 0, np.nan, 0, 1)},
        {"max_range": 0.0},
        {"max_range": np.nan},
        {"max_objects": 0},
    ],
)
def test_a_region_that_cannot_be_is_refused(bad):
    with pytest.raises(InputError, match=next(iter(bad))):
        Region(**bad)


def test_too_many_objects_stop_with_one_line():
    rng = np.random.default_rng(1)
    table = rng.uniform([0, 0, 0], [1, 1, 0], (20_000, 3))
    block = rng.uniform([0, 0, 0], [0.04, 0.04, 0.06], (500, 3))
    blocks = [block + np.array([0.05 + 0.1 * i, 0.05 + 0.1 * j, 0]) for i in range(4) for j in range(3)]
    cloud = PointCloud(np.concatenate([table, *blocks]))
    clusters = SegmentationSettings(method="clusters")
    assert len(segmented_scene(cloud, "z", clusters).cloud.objects) == 12
    with pytest.raises(InputError, match=r"cut into 12 objects, but at most 11 .*--roi, --max-range"):
        segmented_scene(cloud, "z", clusters, Region(max_objects=11))
