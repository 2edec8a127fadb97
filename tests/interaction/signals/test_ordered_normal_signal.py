"""Ordered categories as bands of a hidden normal: by hand, fitted, beside the category model, saved, bad input."""

import numpy as np
import pytest
from scipy.optimize import approx_fprime
from scipy.stats import norm

from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.golf.golf import EDGES, Golf, category_of
from lifelore.interaction.signals import ordered_normal_fit
from lifelore.interaction.signals.ordered_normal_signal import OrderedNormalSignal

GOLF = Golf()
MEAN, DEVIATION, CUTS = np.array([[0.0, 3.0], [-8.0, 12.0]]), np.array([[1.0, 2.0], [4.0, 0.5]]), [-5.0, 0.0, 5.0]


def shots(generator: np.random.Generator, n: int) -> np.ndarray:
    """Categories of `n` shots of each club at each hole, (n_holes, n_clubs, n)."""
    holes = np.ones((len(GOLF.holes), GOLF.n_clubs, n)) * np.array(GOLF.holes)[:, None, None]
    return category_of(GOLF.sample_errors(generator, holes, np.arange(GOLF.n_clubs)[:, None]))


def test_probabilities_by_the_normal_distribution():
    signal = OrderedNormalSignal(MEAN, DEVIATION, CUTS, lapse=0.0)
    ends = np.array([-np.inf, *CUTS, np.inf])
    for type_, policy in np.ndindex(2, 2):
        expected = np.diff(norm.cdf(ends, MEAN[type_, policy], DEVIATION[type_, policy]))
        assert signal.probs[type_, policy] == pytest.approx(expected, abs=1e-15)
    assert signal.log_likelihood(1, 3) == pytest.approx(norm.logsf(5.0, MEAN[:, 1], DEVIATION[:, 1]))
    assert signal.table().probs == pytest.approx(signal.probs, abs=1e-9)
    assert (signal.n_types, signal.n_policies, signal.n_categories) == (2, 2, 4)


@pytest.mark.parametrize("spacing", [None, np.array([3.0, 1.0, 2.0]), np.empty(0)])
def test_the_gradient_is_that_of_differences(spacing):
    random = np.random.default_rng(0)
    counts = random.integers(0, 5, (3, 2, 5 if spacing is None else spacing.size + 2)).astype(float)
    counts[0, 0] = [4, *[0] * (counts.shape[2] - 1)]
    x = ordered_normal_fit._start(counts + (counts.sum(axis=2, keepdims=True) == 0), spacing)
    x = x + random.normal(scale=0.3, size=x.size)

    def value(x):
        return ordered_normal_fit._penalised(x, counts, spacing, 5.0)[0]

    given = ordered_normal_fit._penalised(x, counts, spacing, 5.0)[1]
    assert given == pytest.approx(approx_fprime(x, value, 1e-6), rel=1e-4, abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("cuts", [None, EDGES])
def test_many_runs_find_the_probabilities(cuts):
    signal = OrderedNormalSignal.from_samples(shots(np.random.default_rng(0), 1000), 7, cuts)
    # A share of 1000 deviates by at most 0.016; four of them.
    assert signal.probs == pytest.approx(GOLF.category_probs, abs=0.064)
    if cuts is not None:
        # The 3-wood at 220 yards and the 6-iron at 150 cross several cut points: both numbers are in yards.
        assert signal.mean[[3, 1], [0, 2]] == pytest.approx([-5.0, 0.0], abs=1.0)
        assert signal.deviation[[3, 1], [0, 2]] == pytest.approx([8.0, 6.0], abs=0.8)
        assert signal.cuts.tolist() == list(EDGES)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([[0.0]], [[0.0]], [1.0]), "deviation positive"),
        (([[np.nan]], [[1.0]], [1.0]), "mean must be finite"),
        (([[0.0]], [[1.0, 2.0]], [1.0]), "mean and deviation must both be"),
        (([[0.0]], [[1.0]], [1.0, 1.0]), "finite and rising"),
        (([[0.0]], [[1.0]], []), "cuts must be at least one number"),
        (([[0.0]], [[1.0]], [1.0], None, 1.5), "lapse must lie in"),
        (([[0.0]], [[1.0]], [1.0], ["a"]), "categories must be 2 distinct names"),
    ],
)
def test_models_that_are_none_are_refused(arguments, message):
    with pytest.raises(InputError, match=message):
        OrderedNormalSignal(*arguments)


@pytest.mark.parametrize(
    ("samples", "options", "message"),
    [
        ([[[0, 7]]], {"n_categories": 7}, "category numbers 0 to 6"),
        ([[[0.5]]], {}, "category numbers"),
        ([[[0]]], {}, "at least 2 categories"),
        ([[[0, 1]]], {"n_categories": 4, "cuts": [1.0]}, "cuts one fewer"),
        ([[[0, 1]]], {"shrinkage": 0.0}, "shrinkage must be above 0"),
        ([[[0, 1], [np.nan, np.nan]]], {}, "sample"),
    ],
)
def test_samples_that_are_none_are_refused(samples, options, message):
    with pytest.raises(InputError, match=message):
        OrderedNormalSignal.from_samples(samples, **options)


def test_unknown_signals_and_policies_are_named():
    signal = OrderedNormalSignal(MEAN, DEVIATION, CUTS)
    with pytest.raises(InputError, match="signal must be one of"):
        signal.log_likelihood(0, 4)
    with pytest.raises(NotFoundError, match="unknown policy"):
        signal.log_likelihood(2, 0)
