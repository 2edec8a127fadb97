"""Intervals: by hand, by tables, and where they must not depend on rounding or on missing ratios."""

import numpy as np
import pytest
import scipy.stats

from lifelore.core.intervals import bca_interval, percentile_interval, t_interval, welch_interval


def test_equal_means_count_as_equal_however_they_are_rounded():
    # 0.1 + 0.2 + 0.3 depends on the order, 1 + 2 + 3 does not; many resamples of five values have the same mean.
    whole = bca_interval([np.arange(1.0, 6.0)], np.mean)
    tenths = bca_interval([np.arange(1.0, 6.0) / 10], np.mean)
    assert whole is not None
    assert tenths == pytest.approx(np.divide(whole, 10), rel=1e-9)


def test_resamples_without_a_value_are_left_out():
    def ratio(tops, bottoms, axis):
        below = bottoms.mean(axis=axis)
        return np.divide(tops.mean(axis=axis), below, out=np.full_like(below, np.nan), where=below != 0)

    tops, bottoms = np.array([1.0, 2.0, 0.0, 0.0, 3.0]), np.array([1.0, 1.0, 0.0, 0.0, 2.0])
    found = bca_interval([tops, bottoms], ratio)
    assert 1.0 <= found[0] < 1.5 < found[1] <= 2.0


def test_no_spread_and_too_few():
    assert bca_interval([np.array([1.0, 2.0])], np.mean) is None
    assert bca_interval([np.full(2, 2.0)], np.mean) is None
    assert bca_interval([np.full(9, 2.0)], np.mean) == (2.0, 2.0)
    # The rows differ, but every resample has the mean ratio 2.
    same = np.array([1.0, 2.0, 3.0])
    assert bca_interval([2 * same, same], lambda a, b, axis: a.mean(axis) / b.mean(axis)) == (2.0, 2.0)


def test_percentiles_by_hand():
    assert percentile_interval(np.arange(201.0)) == (5.0, 195.0)


def test_students_interval_by_table():
    low, high = t_interval(np.array([0.0, 1.0]), np.array([1.0, 2.0]), 2)
    assert high.tolist() == pytest.approx([4.30265, 1 + 2 * 4.30265], rel=1e-5)
    assert low.tolist() == pytest.approx([-4.30265, 1 - 2 * 4.30265], rel=1e-5)


def test_welchs_interval_is_students_of_satterthwaites_degrees():
    first, second = [1.0, 2.0, 4.0, 9.0], [0.0, 0.5, 1.0]
    a, b = np.var(first, ddof=1) / 4, np.var(second, ddof=1) / 3
    degrees = (a + b) ** 2 / (a**2 / 3 + b**2 / 2)
    half = scipy.stats.t.ppf(0.975, degrees) * np.sqrt(a + b)
    assert welch_interval(first, second) == pytest.approx((4 - 0.5 - half, 4 - 0.5 + half))
    assert welch_interval(first, [1.0, 2.0]) is None
    assert welch_interval([1.0] * 3, [2.0] * 3) is None
