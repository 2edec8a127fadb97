"""What each peer sees of a pair, worked by hand and beside a plain twin."""

import numpy as np
import pytest

from reproduction.own.o_07_unseen_scenes.peers import orientation_trees as orientation
from reproduction.own.o_07_unseen_scenes.peers.bounding_box_rule import BoundingBoxRule, boxes
from reproduction.own.o_07_unseen_scenes.peers.described_pairs import DescribedPair
from reproduction.own.o_07_unseen_scenes.peers.orientation_trees import orientation_histogram

from .conftest import box

HIGH = np.array([[0.0, 0.0, 0.10]])
LOW = np.array([[0.0, 0.0, 0.05]])


def test_orientation_histogram_by_hand():
    # 5 cm straight up: the last elevation bin, and the third distance bin, 4 to 7 cm.
    above = orientation_histogram(HIGH, LOW).reshape(orientation.ELEVATION_BINS, -1)
    assert above[-1, 2] == 1
    assert above.sum() == 1
    # Level at 20 cm: the first bin above the middle, 16 to 23 cm.
    level = orientation_histogram(HIGH + np.array([0.2, 0, 0]), HIGH).reshape(orientation.ELEVATION_BINS, -1)
    assert level[orientation.ELEVATION_BINS // 2, 5] == 1


def test_boxes_by_hand():
    top, bottom = box((0.0, 0, 0.1), (0.1, 0.1, 0.1)), box((0.05, 0, 0), (0.1, 0.2, 0.1))
    low, high, other_low, other_high, overlap = boxes(top, bottom)
    assert (low, high, other_low, other_high) == pytest.approx((0.1, 0.2, 0.0, 0.1), abs=0.002)
    assert overlap == pytest.approx(0.5)


def seen(*rows: list[float], gap: float = 0.001, b: int = 3) -> tuple[DescribedPair]:
    return (DescribedPair(2, b, gap, np.array(rows, float)),)


@pytest.mark.parametrize(
    ("row", "gap", "b", "expected"),
    [
        ([0.1, 0.2, 0.0, 0.11, 1.0], 0.001, 3, (2, 3, "on")),
        ([0.0, 0.1, 0.09, 0.2, 1.0], 0.001, 3, (3, 2, "on")),
        ([0.04, 0.2, 0.0, 0.1, 1.0], 0.001, 3, (2, 3, "both")),
        ([0.0, 0.1, 0.03, 0.2, 1.0], 0.001, 3, (3, 2, "both")),
        ([0.0, 0.1, 0.0, 0.1, 0.0], 0.020, 3, (2, 3, "adjacent")),
        ([0.0, 0.1, 0.0, 0.1, 0.0], 0.025, 3, (2, 3, "none")),
        ([0.1, 0.2, 0.0, 0.11, 0.1], 0.025, 3, (2, 3, "none")),
        ([0.01, 0.2, 0.0, 0.0, 1.0], 0.001, 1, (2, 1, "on")),
        ([0.03, 0.2, 0.0, 0.0, 1.0], 0.001, 1, (2, 1, "none")),
    ],
)
def test_the_rule_of_boxes(row, gap, b, expected):
    (said,) = BoundingBoxRule().predict(seen(row, gap=gap, b=b))
    assert (said.a, said.b, said.relation) == expected
