"""Measures of C4.13 on confusions made by hand, and a tiny run."""

import numpy as np
import pytest

from reproduction.chapter4.ball_game.games import DEFAULT
from reproduction.chapter4.c4_13_type_naming.measure import measure, right_of, share
from reproduction.chapter4.c4_13_type_naming.run import WAYS, cells, confusion, run_cell
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.13")


def test_confusion_and_shares_by_hand():
    counts = confusion(np.array([0, 0, 1, 2]), np.array([0, 1, 1, 0]), 3)
    assert counts == [[1, 1, 0], [0, 1, 0], [1, 0, 0]]
    assert right_of(counts, [0, 1]).value == pytest.approx(2 / 3)
    # Wilson's interval of 8 in 10.
    assert share(8, 10).ci95 == pytest.approx((0.4902, 0.9433), abs=1e-4)


def made(half):
    return [
        {"game": DEFAULT, "way": way, "half": half, "at_40": half, "first": half, "last": half, "lengths": [60]}
        for way in WAYS
    ]


def test_measures_by_hand():
    half = (100 * np.eye(6)).astype(int)
    half[0, :2] = [55, 45]
    half[1, :2] = [10, 90]
    half[2, 2:4] = [88, 12]
    found = measure({}, made(half.tolist()))
    assert found["right_half_large"].value == 1
    assert found["least_right_half_but_smallest"].value == 0.88
    assert found["smallest_above_worst"].value == pytest.approx(0.55 - 0.88)
    assert found["two_and_five_of_confusions"].value == 55 / 67
    assert found["pairs_confused_more_often"].value == 0
    plain = {name: number.to_dict() for name, number in found.items()}
    assert CLAIM.predicate.verdict(plain) == "holds"
    half[3, 3:5] = [40, 60]
    assert measure({}, made(half.tolist()))["pairs_confused_more_often"].value == 1


def test_a_tiny_run_counts_everybody_to_the_end():
    settings = CLAIM.settings("quick", {"players": 5, "training": 6})
    result = run_cell(settings, cells(settings)[0], 0)
    for when in ("half", "at_40", "first", "last"):
        assert np.sum(result[when], axis=1).tolist() == [5] * 6
    right, ratio = np.array(result["right"]), np.array(result["ratio"])
    # Who has finished keeps her belief: the last step kept is the belief after the episode.
    assert right[:, -1] == pytest.approx(np.diag(result["first"]) / 5)
    assert ((ratio > 1 / 31) & (ratio < 31)).all()
    named = np.array(result["needed"])
    assert len(named) == 30
    assert (named >= -1).all()
