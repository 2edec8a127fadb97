"""Exact shares against the closed forms and SciPy's own interval."""

import math

import pytest
from scipy.stats import binomtest

from reproduction.engine.estimates import UNMEASURED, exact_share, mean_or_unmeasured, ratio_or_unmeasured


def test_all_and_none_have_closed_forms():
    # Of n yeses none are missing where p^n = 0.025.
    assert exact_share([True] * 20).ci95 == pytest.approx((0.025 ** (1 / 20), 1.0))
    assert exact_share([False] * 20).ci95 == pytest.approx((0.0, 1 - 0.025 ** (1 / 20)))


@pytest.mark.parametrize(("right", "n"), [(1, 7), (5, 10), (137, 150)])
def test_interval_is_scipys(right, n):
    found = exact_share([True] * right + [False] * (n - right))
    other = binomtest(right, n).proportion_ci(method="exact")
    assert found.ci95 == pytest.approx((other.low, other.high))
    assert (found.value, found.n) == (right / n, n)


def test_nothing_measured_says_so():
    assert exact_share([]) is UNMEASURED
    assert mean_or_unmeasured(iter(())) is UNMEASURED
    assert math.isnan(UNMEASURED.value)
    assert UNMEASURED.n == 0
    assert mean_or_unmeasured([1.0, 2.0, 6.0]).value == 3.0
    assert ratio_or_unmeasured([0, 1], [0, 0]) is UNMEASURED
    ratio = ratio_or_unmeasured([1, 5, 3], [4, 0, 4])  # the second has nothing to divide by
    assert (ratio.value, ratio.n) == (0.5, 2)
