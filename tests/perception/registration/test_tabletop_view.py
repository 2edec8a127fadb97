"""A view upright on its table: its frame, its parts, and what cannot be registered."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.registration.start_search import turned
from lifelore.perception.registration.tabletop_view import tabletop_view


def test_the_table_lies_at_zero_and_the_objects_middle_at_the_origin(blocks_seen) -> None:
    view = blocks_seen(turned(0.3))
    # The feet of the blocks lie in the table's band.
    assert np.abs(np.median(view.table[:, 2])) < 1e-4
    assert np.abs(view.table[:, 2]).max() < 1e-2
    low, high = view.objects.min(axis=0), view.objects.max(axis=0)
    np.testing.assert_allclose((low + high)[:2] / 2, 0.0, atol=5e-3)
    assert high[2] == pytest.approx(0.15, abs=2e-3)
    np.testing.assert_allclose(np.linalg.norm(view.surface_normals, axis=1), 1.0)
    assert len(view.surface) == len(view.objects) + len(view.table)


def test_labels_name_the_table_and_the_objects(blocks_seen) -> None:
    flat = np.column_stack([np.mgrid[-20:20, -20:20].reshape(2, -1).T / 100.0, np.zeros(1600)])
    block = np.column_stack([np.mgrid[-5:5, -5:5].reshape(2, -1).T / 200.0, np.full(100, 0.06)])
    noise = np.full((50, 3), 0.3)
    points = np.concatenate([flat, block, noise])
    labels = np.repeat([1, 2, 0], [1600, 100, 50])
    view = tabletop_view(PointCloud(points, labels, camera=np.array([0.0, 0.0, 1.0])))
    assert view.objects[:, 2].max() == pytest.approx(0.06)


def test_a_bare_table_and_no_table_are_refused() -> None:
    flat = np.column_stack([np.mgrid[-40:40, -40:40].reshape(2, -1).T / 100.0, np.zeros(6400)])
    camera = np.array([0.0, 0.0, 1.0])
    with pytest.raises(InputError, match="nothing stands on the table"):
        tabletop_view(PointCloud(flat, camera=camera))
    ball = np.random.default_rng(1).normal(size=(4000, 3))
    with pytest.raises(InputError, match="no table was found"):
        tabletop_view(PointCloud(ball, camera=camera))
