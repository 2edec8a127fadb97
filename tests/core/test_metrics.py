"""Metrics: by hand, and SciPy's own bootstrap on the same draws as oracle."""

import numpy as np
import pytest
import scipy.stats
from hypothesis import strategies as st

from lifelore.core import InputError, difference_estimate, mean_estimate, stream
from lifelore.core.intervals import RESAMPLES
from lifelore.core.metrics import entropy, ratio_estimate

floats = st.floats(-100, 100, allow_subnormal=False)


def scipy_interval(data, statistic, draws, n_resamples=RESAMPLES, **how):
    found = scipy.stats.bootstrap(
        data, statistic, method="BCa", n_resamples=n_resamples, rng=draws, vectorized=True, **how
    )
    return tuple(found.confidence_interval)


def mean_ratio(top, bottom, axis=-1):
    return np.mean(top, axis=axis) / np.mean(bottom, axis=axis)


@pytest.mark.parametrize(("n", "law"), [(8, "poisson"), (30, "exponential"), (200, "lognormal")])
def test_mean_interval_is_scipys_on_the_same_draws(n, law):
    # Few values come as whole numbers: SciPy takes equal means of fractions for unequal where rounding differs.
    values = getattr(np.random.default_rng(n), law)(size=n)
    ours = mean_estimate(values)
    assert ours.ci95 == pytest.approx(scipy_interval((values,), np.mean, stream(n, "bootstrap")), rel=1e-9)
    assert (ours.value, ours.median, ours.n) == (values.mean(), np.median(values), n)


def test_ratio_interval_is_scipys_on_the_same_draws():
    random = np.random.default_rng(3)
    top, bottom = random.exponential(size=40), random.uniform(1, 2, 40)
    ours = ratio_estimate(top, bottom)
    theirs = scipy_interval((top, bottom), mean_ratio, stream(40, "bootstrap"), paired=True)
    assert ours.ci95 == pytest.approx(theirs, rel=1e-9)


def test_ratio_by_hand():
    found = ratio_estimate([1.0, 4.0, 0.0], [2.0, 2.0, 0.0])
    # Means 5/3 over 4/3; own ratios ½ and 2, the third pair has none.
    assert (found.value, found.median, found.n) == (pytest.approx(1.25), 1.25, 3)
    nothing = ratio_estimate([1.0, 2.0, 3.0], [0.0, 0.0, 0.0])
    assert np.isnan(nothing.value)
    assert np.isnan(nothing.median)
    assert nothing.ci95 is None


def test_difference_is_the_mean_of_the_pairs_own():
    found = difference_estimate([3.0, 5.0, 10.0], [1.0, 1.0, 1.0])
    assert (found.value, found.median, found.n) == (5.0, 4.0, 3)
    assert found == mean_estimate([2.0, 4.0, 9.0])
    with pytest.raises(InputError, match="agree in number, got 3 and 1"):
        difference_estimate([3.0, 5.0, 7.0], [1.0])


@pytest.mark.parametrize("values", [[], [np.nan, 1.0], [np.inf]])
def test_values_that_break_a_rule(values):
    with pytest.raises(InputError, match="values must be at least one number, all finite"):
        mean_estimate(values)
    with pytest.raises(InputError):
        ratio_estimate(values, [1.0] * len(values))
    with pytest.raises(InputError, match="got 1 and 2"):
        ratio_estimate([1.0], [1.0, 2.0])


def test_entropy_by_hand():
    probs = np.array([[0.5, 0.5, 0.0], [1.0, 0.0, 0.0], [1 / 3, 1 / 3, 1 / 3]])
    assert entropy(probs) == pytest.approx([np.log(2), 0.0, np.log(3)])
