"""A cut divides one object and leaves everything else."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.experiments.chapter2.cut_objects import cut_object

CLOUD = LabelledCloud(
    np.array([[0, 0, 0], [0, 0, 0.1], [0, 0, 0.2], [0, 0, 0.3], [1, 0, 0.3]], float), np.array([TABLE, 2, 2, 2, 5])
)


def test_the_part_beyond_gets_a_new_label():
    cloud, part = cut_object(CLOUD, 2, (0, 0, 1), (0, 0, 0.15))
    assert part == 6
    assert cloud.labels.tolist() == [TABLE, 2, 6, 6, 5]
    assert (cloud.points == CLOUD.points).all()


@pytest.mark.parametrize(("label", "height"), [(2, 0.5), (2, -0.5), (3, 0.1), (TABLE, 0.1)])
def test_planes_that_divide_nothing_are_refused(label, height):
    with pytest.raises(InputError, match="must divide"):
        cut_object(CLOUD, label, (0, 0, 1), (0, 0, height))
