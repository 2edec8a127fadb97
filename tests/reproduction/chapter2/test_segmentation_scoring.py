"""Measures of a segmentation, worked by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from reproduction.chapter2.scoring.segmentation_scoring import (
    matched_objects,
    overlaps,
    segmentation_score,
)


def labels(text: str) -> np.ndarray:
    return np.array([int(digit) for digit in text], np.int64)


def test_a_split_object_is_over_segmented():
    # Object 2 has 6 points, 4 and 2 of them in two segments; object 3 has 4 points in one.
    score = segmentation_score([overlaps(labels("2222223333"), labels("2222334444"))])
    assert score.over.value == pytest.approx(2 / 10)
    assert score.under.value == 0
    assert score.weighted_overlap.value == pytest.approx((6 * 4 / 6 + 4 * 1) / 10)


def test_two_objects_in_one_segment_are_under_segmented():
    found = overlaps(labels("222223333"), labels("555555555"))
    # For object 2 the 4 points of object 3 are wrong, and the other way round.
    assert [(o.right, o.wrong) for o in found] == [(5, 4), (4, 5)]
    score = segmentation_score([found])
    assert (score.over.value, score.under.value) == (0, 1)
    assert score.weighted_overlap.value == pytest.approx((5 * 5 / 9 + 4 * 4 / 9) / 9)
    assert score.found.value == 0.5
    assert matched_objects(found) == {5: 2}


def test_points_of_the_table_and_points_left_over():
    # One point of the object is called table, one of the table object; a point without truth does not count.
    (only,) = overlaps(labels("1112220"), labels("1122212"))
    assert (only.points, only.right, only.wrong) == (3, 2, 1)
    assert only.iou == pytest.approx(2 / 4)
    assert only.found
    (lost,) = overlaps(labels("1122"), labels("1100"))
    assert (lost.iou, lost.segment, lost.right, lost.wrong) == (0, 0, 0, 0)
    assert matched_objects([lost]) == {}


def test_scenes_weigh_by_their_points():
    right, wrong = overlaps(labels("222222"), labels("333333")), overlaps(labels("22"), labels("11"))
    score = segmentation_score([right, [], wrong])
    assert score.weighted_overlap.value == pytest.approx(6 / 8)
    assert score.over.value == pytest.approx(2 / 8)
    assert (score.found.value, score.found.n) == (0.5, 2)


def test_mistakes_are_refused():
    with pytest.raises(InputError, match="same length"):
        overlaps(labels("12"), labels("1"))
    with pytest.raises(InputError, match="at least one object"):
        segmentation_score([[]])
