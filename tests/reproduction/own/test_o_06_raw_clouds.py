"""O6: shares and gains by hand, and a method that finds no colours."""

import numpy as np
import pytest

from lifelore.perception.clouds.point_cloud import PointCloud
from reproduction.own.o_06_raw_clouds.run import labels_by, measure, measures_of, readings


def test_measures_by_hand():
    first = {
        "convexity": [[10, 0.8], [30, 0.6]],
        "clusters": [[10, 0.4], [30, 0.6]],
        "colour": [[10, 0.1], [30, 0.2]],
    }
    second = {"convexity": [[20, 0.4]], "clusters": [[20, 0.9]], "colour": [[20, 0.0]]}
    results = [{"scenes": "simulated", "found": [first, second]}]
    found = measures_of(results, "simulated")
    assert found["found_convexity"].value == pytest.approx(2 / 3)
    assert found["more_than_clusters"].value == 0
    assert found["more_than_colour"].value == pytest.approx(2 / 3)
    assert found["weighted_overlap"].value == pytest.approx((8 + 18 + 8) / 60)
    assert np.isnan(measure({}, results)["found_convexity_real"].value)
    assert [cell for cell, _ in readings({}, results)] == [{"scenes": "simulated"}]


def test_a_scene_without_colours_has_no_object_by_colour():
    points = np.random.default_rng(0).uniform(0, 0.2, (500, 3))
    points[:400, 2] = 0
    grey = np.full((500, 3), 128, np.uint8)
    assert not labels_by(PointCloud(points, None, grey, camera=np.array([0.0, -0.7, 0.5])), "z", "colour").any()
