"""C2.4: what is timed and what is not, and the numbers by hand; no time is asserted."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from reproduction.chapter2.c2_04_time_per_image import run as image_timing
from reproduction.chapter2.c2_04_time_per_image.run import made_dense, measure, timed_image


def test_measures_by_hand():
    images = [{"kind": "stereo", "points": 100, "seconds": seconds} for seconds in (0.1, 0.6, 0.2, 0.3)]
    images += [{"kind": "dense", "points": 900, "seconds": 0.7}]
    results = [{"images": images[:2]}, {"images": images[2:]}]
    found = measure({}, results)
    assert found["seconds_stereo"].value == pytest.approx(0.3)
    assert found["seconds_stereo_95_percent"].value == pytest.approx(0.3 + 0.85 * 0.3)
    assert (found["points_dense"].value, found["seconds_dense"].value) == (900, 0.7)


def test_of_the_repeats_the_one_in_the_middle_counts(monkeypatch):
    takes = iter([0.3, 0.1, 0.2])
    monkeypatch.setattr(image_timing, "seconds_of", lambda cloud, model: next(takes))
    cloud = LabelledCloud(np.zeros((3, 3)), np.array([TABLE, 2, 3]))
    assert timed_image(cloud, None, 3) == {"points": 3, "seconds": 0.2}  # type: ignore[arg-type]


def test_a_dense_cloud_has_more_points_of_things_and_the_same_table():
    points = np.random.default_rng(0).uniform(0, 0.1, (30, 3))
    labels = np.repeat([TABLE, 2, 3], [10, 15, 5])
    dense = made_dense(LabelledCloud(points, labels), 70, np.random.default_rng(1))
    assert np.bincount(dense.labels).tolist() == [0, 10, 60, 20]
    np.testing.assert_array_equal(dense.of(TABLE), points[:10])
    assert 0 < np.abs(dense.of(2) - np.repeat(points[10:25], 4, axis=0)).max() < 0.005
