"""Several views as one cloud, by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.fused_views import fused
from lifelore.perception.clouds.point_cloud import PointCloud

TURN = np.array([[0.0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
WORLD = np.array([[2.0, 0, 0, 5], [0, 2, 0, 0], [0, 0, 2, 0], [0, 0, 0, 2]]) / 2
"""The first camera stands at (2.5, 0, 0)."""
LABELS = np.array([2, 3])


def view(points, labels=None, camera=True) -> PointCloud:
    colours = np.full((len(points), 3), 9, np.uint8)
    return PointCloud(np.array(points, float), labels, colours, camera=np.zeros(3) if camera else None)


def test_points_and_cameras_stand_in_the_first_frame() -> None:
    first, second = view([[0, 0, 1.0], [np.nan, 0, 0]], LABELS), view([[1, 0, 0], [0, 0, 0]], LABELS)
    whole = fused([first, second], np.stack([WORLD, WORLD @ TURN]))
    # (1, 0, 0) is turned to (0, 1, 0) and shifted.
    np.testing.assert_allclose(whole.points, [[0, 0, 1], [1, 3, 3], [1, 2, 3]], atol=1e-12)
    assert whole.labels.tolist() == [2, 2, 3]
    assert whole.other_cameras is not None
    assert whole.camera.tolist() == [0, 0, 0]
    np.testing.assert_allclose(whole.other_cameras, [[1, 2, 3]], atol=1e-12)
    assert whole.colours is not None
    assert whole.grid is None
    assert whole.source_rows.tolist() == [-1, -1, -1]


def test_a_place_seen_twice_is_one_point_for_each_label() -> None:
    both = np.stack([np.eye(4), np.eye(4)])
    twice = fused([view([[0.001, 0, 1]], LABELS[:1]), view([[0.002, 0, 1]], LABELS[:1])], both)
    np.testing.assert_allclose(twice.points, [[0.0015, 0, 1]])
    assert len(fused([view([[0.001, 0, 1]], LABELS[:1]), view([[0.002, 0, 1]], LABELS[1:])], both).points) == 2
    assert fused([view([[0.0, 0, 1]]), view([[0.0, 0, 1]], camera=False)], both).other_cameras is None
    assert fused([view([[0.0, 0, 1]]), view([[0.0, 0, 1]])], both).labels is None


def test_views_that_do_not_fit_are_refused() -> None:
    poses = np.stack([np.eye(4), np.eye(4)])
    with pytest.raises(InputError, match="all have labels or none, but only 1 of 2"):
        fused([view([[0, 0, 1.0]]), view([[0, 0, 1.0]], LABELS[:1])], poses)
    with pytest.raises(InputError, match="a measured point"):
        fused([view([[0, 0, 1.0]]), view([[np.nan, 0, 1.0]])], poses)
    with pytest.raises(InputError, match=r"poses must have shape \(1, 4, 4\)"):
        fused([view([[0, 0, 1.0]])], poses)
