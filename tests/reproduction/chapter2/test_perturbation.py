"""Spoilt clouds: how many points go, where they move, which labels change and which never do."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from reproduction.chapter2.scenes.perturbation import cut_object, fewer_points

CAMERA = np.array([0.0, 0.0, 1.0])


@pytest.fixture
def cloud() -> LabelledCloud:
    """Rows of points 1 mm apart: object 2 from 0 to 100 mm, 3 from 103.5 mm on, the table 20 mm below."""
    x = np.arange(0, 0.2, 0.001)
    thing = np.stack([x, 0 * x, 0 * x], axis=1)
    thing[x > 0.1005, 0] += 0.0025
    table = thing - [0, 0, 0.02]
    labels = np.concatenate([np.where(x > 0.1005, 3, 2), np.ones(len(x), int)])
    colours = np.arange(2 * len(x), dtype=np.uint8)[:, None].repeat(3, axis=1)
    return LabelledCloud(np.concatenate([thing, table]), labels.astype(np.int64), colours, CAMERA)


def test_points_are_discarded_with_their_labels_and_colours(cloud):
    fewer = fewer_points(cloud, 0.7, np.random.default_rng(0))
    # 400 points, each kept with 0.3: 120 ± 9.2; four standard deviations.
    assert 83 <= len(fewer.points) <= 157
    at = [int(np.flatnonzero((cloud.points == point).all(axis=1))[0]) for point in fewer.points]
    assert (cloud.labels[at] == fewer.labels).all()
    assert fewer.colours is not None
    assert (cloud.colours[at] == fewer.colours).all()
    assert len(fewer_points(cloud, 0.0, np.random.default_rng(0)).points) == 400


# --- an object cut into two ---------------------------------------------------------------------------------

STACKED = LabelledCloud(
    np.array([[0, 0, 0], [0, 0, 0.1], [0, 0, 0.2], [0, 0, 0.3], [1, 0, 0.3]], float), np.array([TABLE, 2, 2, 2, 5])
)


def test_the_part_beyond_gets_a_new_label():
    cloud, part = cut_object(STACKED, 2, (0, 0, 1), (0, 0, 0.15))
    assert part == 6
    assert cloud.labels.tolist() == [TABLE, 2, 6, 6, 5]
    assert (cloud.points == STACKED.points).all()
