"""Labels of the table beside masks: the band grows with range, and only the table's surface is labelled."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.segmentation.table_labels import with_table

CAMERA = np.array([0.0, -1.6, 1.3])


def scene(noise: float) -> tuple[PointCloud, np.ndarray]:
    """A table 2 m from the camera with a box on it, and level ground of the same height beyond a gap."""
    rng = np.random.default_rng(0)
    top = np.column_stack([rng.uniform(-0.5, 0.5, 9000), rng.uniform(-0.4, 0.4, 9000), rng.normal(0, noise, 9000)])
    beyond = np.column_stack([rng.uniform(1.2, 1.5, 800), rng.uniform(-0.4, 0.4, 800), np.zeros(800)])
    box = rng.uniform([0, 0, 0.05], [0.15, 0.15, 0.2], (3000, 3))
    box[np.arange(3000) % 3 == 0, 2] = 0.2
    unmeasured = np.full((50, 3), np.nan)
    points = np.concatenate([top, beyond, box, unmeasured])
    parts = np.repeat([0, 1, 2, 3], [9000, 800, 3000, 50])
    return PointCloud(points, np.where(parts == 2, 2, 0), camera=CAMERA), parts


@pytest.mark.parametrize("up", ["table", "z", (0.0, 0.0, 3.0)])
def test_the_noise_of_a_far_table_is_table_and_the_rest_keeps_its_labels(up):
    cloud, parts = scene(noise=0.012)
    labels = with_table(cloud, up).labels
    # A band of 10 mm would hold 60 % of these points; at 2 m it is 24 mm.
    assert (labels[parts == 0] == TABLE).mean() > 0.93
    assert not (labels[parts == 1] == TABLE).any()
    assert (labels[parts == 2] == 2).all()
    assert (labels[parts == 3] == 0).all()


def test_a_table_that_is_labelled_or_not_level_changes_nothing():
    cloud, _ = scene(noise=0.002)
    assert with_table(cloud, (1.0, 0.0, 0.0)) is cloud
    labelled = with_table(cloud, "z")
    assert with_table(labelled, "z") is labelled
    bare = PointCloud(cloud.points, camera=CAMERA)
    assert with_table(bare) is bare
