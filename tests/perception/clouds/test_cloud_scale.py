"""Metres and other units, and points no sensor can have seen."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_scale import UNITS, in_metres
from lifelore.perception.clouds.point_cloud import PointCloud

RNG = np.random.default_rng(5)
TABLE_TOP = RNG.uniform([-0.5, -0.3, 0.6], [0.5, 0.3, 1.4], (500, 3))


def test_metres_stay_as_they_are():
    np.testing.assert_array_equal(in_metres(PointCloud(TABLE_TOP)).points, TABLE_TOP)


@pytest.mark.parametrize("unit", ["cm", "mm", "inch"])
def test_other_units_are_noticed_named_and_understood(unit):
    numbers = TABLE_TOP / UNITS[unit]
    with pytest.raises(InputError, match=rf"looks like {unit}: .*--units {unit}\)"):
        in_metres(PointCloud(numbers))
    np.testing.assert_allclose(in_metres(PointCloud(numbers), unit).points, TABLE_TOP)


def test_a_single_small_object_in_millimetres_is_noticed():
    """It might be a table in inches too, so its width in each unit is named."""
    cube = RNG.uniform(0, 30.0, (500, 3))
    with pytest.raises(InputError, match=r"looks like inch: .* m in cm, .* m in mm, .* m in inch"):
        in_metres(PointCloud(cube))


def test_millimetres_become_metres_with_their_camera():
    cloud = in_metres(PointCloud(TABLE_TOP * 1000, camera=np.array([0.0, 0, 1000])), "mm")
    np.testing.assert_allclose(cloud.points, TABLE_TOP)
    assert cloud.camera.tolist() == [0, 0, 1]


def test_metres_taken_for_millimetres_are_noticed():
    with pytest.raises(InputError, match="in metres already; pass units=m"):
        in_metres(PointCloud(TABLE_TOP), "mm")
    with pytest.raises(InputError, match="crop"):
        in_metres(PointCloud(TABLE_TOP * 1e5), "mm")


def test_a_stray_point_is_dropped_and_does_not_count_for_the_width():
    far = TABLE_TOP.copy()
    far[3] = [0, 0, 1e30]
    far[5, 1] = np.inf
    cloud = in_metres(PointCloud(far))
    assert np.flatnonzero(~cloud.measured).tolist() == [3, 5]
    assert np.isnan(cloud.points[[3, 5]]).all()
    assert far[3, 2] == 1e30  # the caller's array is left alone


def test_a_small_scene_far_from_the_origin_of_its_map_is_a_scene():
    np.testing.assert_array_equal(in_metres(PointCloud(TABLE_TOP + 5e6)).points, TABLE_TOP + 5e6)
    with pytest.raises(InputError, match="too far to resolve millimetres"):
        in_metres(PointCloud(TABLE_TOP + 1e12))


def test_identical_points_are_no_scale_at_all():
    assert in_metres(PointCloud(np.ones((9, 3))), "mm").points[0].tolist() == [0.001] * 3


@pytest.mark.parametrize("points", [np.empty((0, 3)), np.full((4, 3), np.nan)])
def test_nothing_finite_is_refused(points):
    with pytest.raises(InputError, match="no finite point"):
        in_metres(PointCloud(points))


def test_other_units_are_refused():
    with pytest.raises(InputError, match="units must be m, cm, mm or inch, got 'feet'"):
        in_metres(PointCloud(TABLE_TOP), "feet")
