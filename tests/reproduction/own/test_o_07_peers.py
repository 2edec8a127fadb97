"""O7: what each peer sees of a pair, the rule of boxes, and what trees learn, worked by hand."""

import numpy as np
import pytest

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.perception.pairs.pair_features import PairFeatures
from lifelore.perception.pairs.scene_pairs import ScenePairs
from reproduction.own.o_07_unseen_scenes import peers
from reproduction.own.o_07_unseen_scenes.peers import (
    BoundingBoxRule,
    OrientationTrees,
    boxes,
    described,
    orientation_histogram,
    pairs_of_objects,
)
from tests.perception.conftest import box_surface

HIGH = np.array([[0.0, 0.0, 0.10]])
LOW = np.array([[0.0, 0.0, 0.05]])


def box(low, size):
    return box_surface(low, np.add(low, size), 0.01)


def test_orientation_histogram_by_hand():
    # 5 cm straight up: the last elevation bin, and the third distance bin, 4 to 7 cm.
    above = orientation_histogram(HIGH, LOW).reshape(peers.ELEVATION_BINS, -1)
    assert above[-1, 2] == 1
    assert above.sum() == 1
    # Level at 20 cm: the first bin above the middle, 16 to 23 cm.
    level = orientation_histogram(HIGH + np.array([0.2, 0, 0]), HIGH).reshape(peers.ELEVATION_BINS, -1)
    assert level[peers.ELEVATION_BINS // 2, 5] == 1


def test_boxes_by_hand():
    top, bottom = box((0.0, 0, 0.1), (0.1, 0.1, 0.1)), box((0.05, 0, 0), (0.1, 0.2, 0.1))
    low, high, other_low, other_high, overlap = boxes(top, bottom)
    assert (low, high, other_low, other_high) == pytest.approx((0.1, 0.2, 0.0, 0.1), abs=0.002)
    assert overlap == pytest.approx(0.5)


def seen(*rows, a=2, b=3, gap=0.001) -> ScenePairs:
    """A pair of a scene with a row for either order."""
    return ScenePairs(PairFeatures((), np.array(rows, float), np.array([[a, b], [b, a]]), np.full(2, gap)), ())


@pytest.mark.parametrize(
    ("row", "gap", "expected"),
    [
        ([0.1, 0.2, 0.0, 0.11, 1.0], 0.001, (2, 3, "on")),
        ([0.0, 0.1, 0.09, 0.2, 1.0], 0.001, (3, 2, "on")),
        ([0.04, 0.2, 0.0, 0.1, 1.0], 0.001, (2, 3, "both")),
        ([0.0, 0.1, 0.03, 0.2, 1.0], 0.001, (3, 2, "both")),
        ([0.0, 0.1, 0.0, 0.1, 0.0], 0.020, (2, 3, "adjacent")),
        ([0.0, 0.1, 0.0, 0.1, 0.0], 0.025, (2, 3, "none")),
        ([0.1, 0.2, 0.0, 0.11, 0.1], 0.025, (2, 3, "none")),
    ],
)
def test_the_rule_of_boxes(row, gap, expected):
    (said,) = BoundingBoxRule().predict(seen(row, row, gap=gap))
    assert (said.a, said.b, said.relation) == expected


def test_trees_learn_relations_and_the_order_of_names_carries_nothing():
    """The first number of a row is how much the first object is above the other."""
    scenes = [seen([1, 0], [-1, 0]), seen([-1, 0], [1, 0]), seen([0, 0], [0, 0])] * 3
    labels = [PairLabel(2, 3, "on"), PairLabel(3, 2, "on"), PairLabel(3, 2, "adjacent")] * 3
    doubtful = PairLabel(2, 3, "adjacent", 1)
    model = OrientationTrees().fit([*scenes, seen([1, 0], [-1, 0])], [*([one] for one in labels), [doubtful]])
    for rows, expected in zip(
        ([[1, 0], [-1, 0]], [[0, 0], [0, 0]]), ((5, 4, "on"), (4, 5, "adjacent")), strict=True
    ):
        for a, b, own in ((5, 4, rows), (4, 5, rows[::-1])):
            (said,) = model.predict(seen(*own, a=a, b=b))
            assert said.relation == expected[2]
            assert said.confidence == pytest.approx(1.0)
            assert (said.a, said.b) == expected[:2] or said.relation == "adjacent"
    assert model.predict(described([], boxes)) == ()


def test_pairs_of_objects_are_described_in_both_orders_without_the_table():
    parts = [
        box((-0.3, -0.3, 0), (0.6, 0.6, 0)),
        box((0, 0, 0), (0.05, 0.05, 0.05)),
        box((0.06, 0, 0), (0.05, 0.05, 0.1)),
    ]
    labels = np.repeat([TABLE, 2, 3], [len(part) for part in parts])
    scene = described(pairs_of_objects(LabelledCloud(np.concatenate(parts), labels)), boxes)
    assert scene.features.pairs.tolist() == [[2, 3], [3, 2]]
    assert scene.features.matrix[:, 1] == pytest.approx([0.05, 0.1], abs=0.001)
    assert scene.features.gaps == pytest.approx([0.01, 0.01], abs=1e-4)
