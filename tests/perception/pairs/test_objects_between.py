"""What lies between two objects: a slab between two blocks, and blocks with nothing between."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.perception.contacts.interface import interfaces
from lifelore.perception.pairs.objects_between import BETWEEN_COLUMNS, NO_OBJECT, ObjectsBetween
from lifelore.perception.pairs.pair_features import pair_features


def tower(box, *heights) -> LabelledCloud:
    """Blocks 2, 3, … upon one another, as thick as is said, 2 mm of air between."""
    feet = np.cumsum([0.0, *(height + 0.002 for height in heights)])
    parts = [box((0, 0, z), (0.08, 0.08, z + height)) for z, height in zip(feet, heights, strict=False)]
    return LabelledCloud(np.vstack(parts), np.repeat(range(2, 2 + len(parts)), [len(part) for part in parts]))


def columns(cloud, pair):
    features = pair_features(cloud)
    return features.columns(BETWEEN_COLUMNS)[features.pairs.tolist().index(list(pair))]


def test_a_slab_between_two_blocks_is_close_to_the_middle_and_to_both(box):
    cloud = tower(box, 0.06, 0.02, 0.06)
    way, gap_a, gap_b = columns(cloud, (2, 4))
    assert way == pytest.approx(0.01, abs=0.003)
    assert max(gap_a, gap_b) < 0.006
    assert columns(cloud, (4, 2)).tolist() == [way, gap_b, gap_a]


def test_what_lies_beyond_is_far_from_the_middle(box):
    way, gap_a, gap_b = columns(tower(box, 0.06, 0.03, 0.06), (2, 3))
    assert way == pytest.approx(0.03, abs=0.005)
    assert gap_a == pytest.approx(0.034, abs=0.005)
    assert gap_b < 0.006


def test_two_alone_have_no_third(box):
    cloud = tower(box, 0.06, 0.06)
    assert columns(cloud, (2, 3)).tolist() == [NO_OBJECT] * 3
    assert ObjectsBetween(()).between(2, 3, np.zeros(3)) == (NO_OBJECT,) * 3
    assert ObjectsBetween(interfaces(cloud)).between(2, 9, np.zeros(3)) == (NO_OBJECT,) * 3
