"""Overlaps of objects and segments, worked by hand."""

import numpy as np
import pytest

from reproduction.chapter2.scoring.segmentation_scoring import overlaps


def labels(text: str) -> np.ndarray:
    return np.array([int(digit) for digit in text], np.int64)


def test_a_split_object_and_two_objects_in_one_segment():
    # Object 2 has 6 points, 4 and 2 of them in two segments; object 3 has 4 points in one.
    split = overlaps(labels("2222223333"), labels("2222334444"))
    assert [(o.iou, o.right, o.wrong) for o in split] == [(pytest.approx(4 / 6), 4, 0), (1.0, 4, 0)]
    # For object 2 the 4 points of object 3 are wrong, and the other way round.
    joined = overlaps(labels("222223333"), labels("555555555"))
    assert [(o.points, o.right, o.wrong) for o in joined] == [(5, 5, 4), (4, 4, 5)]


def test_points_of_the_table_and_points_left_over():
    # One point of the object is called table, one of the table object; a point without truth does not count.
    assert overlaps(labels("1112220"), labels("1122212")) == [(3, 2 / 4, 2, 1)]
    assert overlaps(labels("1122"), labels("1100")) == [(2, 0.0, 0, 0)]
