"""Exact shares against their closed forms, and estimates over clusters by hand."""

import math

import numpy as np
import pytest

from reproduction.engine.estimates import (
    UNMEASURED,
    exact_share,
    mean_by_cluster,
    mean_or_unmeasured,
    ratio_or_unmeasured,
    share_by_cluster,
)


def test_all_and_none_have_closed_forms():
    # Of n yeses none are missing where p^n = 0.025.
    assert exact_share([True] * 20).ci95 == pytest.approx((0.025 ** (1 / 20), 1.0))
    assert exact_share([False] * 20).ci95 == pytest.approx((0.0, 1 - 0.025 ** (1 / 20)))


def test_mean_weighs_values_and_counts_clusters():
    found = mean_by_cluster([1.0, 0.0, 0.5, 0.5, 0.2], ["a", "a", "b", "c", "c"])
    assert (found.value, found.n) == (pytest.approx(2.2 / 5), 3)
    assert found.ci95[0] < found.value < found.ci95[1]


def test_shares_resample_clusters():
    # Ten scenes of ten answers that are right or wrong together carry no more than ten answers do.
    answers = [bool(s % 2) for s in range(10) for _ in range(10)]
    wide = share_by_cluster(answers, [s for s in range(10) for _ in range(10)])
    narrow = share_by_cluster(answers, range(100))
    assert wide.value == narrow.value == 0.5
    assert wide.n == narrow.n == 100
    # Standard errors of 10 and of 100 fair answers are 0.158 and 0.05.
    assert np.ptp(wide.ci95) > 2 * np.ptp(narrow.ci95)
    assert share_by_cluster([True] * 20, range(20)).ci95 == exact_share([True] * 20).ci95
    assert share_by_cluster([], []) is UNMEASURED


def test_nothing_measured_says_so():
    assert exact_share([]) is UNMEASURED
    assert mean_or_unmeasured(iter(())) is UNMEASURED
    assert math.isnan(UNMEASURED.value)
    assert UNMEASURED.n == 0
    assert mean_or_unmeasured([1.0, 2.0, 6.0]).value == 3.0
    assert ratio_or_unmeasured([0, 1], [0, 0]) is UNMEASURED
    ratio = ratio_or_unmeasured([1, 5, 3], [4, 0, 4])  # the second has nothing to divide by
    assert (ratio.value, ratio.n) == (0.5, 2)
