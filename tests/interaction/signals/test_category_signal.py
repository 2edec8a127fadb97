"""Signals from a few categories, by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.signals.category_signal import CategorySignal

GOLF = [[[0.6, 0.3, 0.1]], [[0.1, 0.2, 0.7]]]


def test_likelihoods_by_hand():
    signal = CategorySignal(GOLF, categories=["short", "near", "far"])
    np.testing.assert_allclose(signal.log_likelihood(0, "near"), np.log([0.3, 0.2]))
    np.testing.assert_allclose(CategorySignal(GOLF).log_likelihood(0, 2), np.log([0.1, 0.7]))
    many = signal.log_likelihoods(np.array([0, 0]), np.array([1, 2]))
    np.testing.assert_allclose(many, np.log([[0.3, 0.2], [0.1, 0.7]]))
    assert (signal.n_types, signal.n_policies, signal.n_categories) == (2, 1, 3)


def test_what_cannot_be_is_minus_infinity():
    signal = CategorySignal([[[1.0, 0.0]], [[0.5, 0.5]]])
    assert signal.log_likelihood(0, 1)[0] == -np.inf


def test_fitted_with_pseudo_counts_by_hand():
    signal = CategorySignal.from_samples([[[0, 0, 2]], [[1, np.nan, np.nan]]])
    np.testing.assert_allclose(signal.probs, np.array([[[2.5, 0.5, 1.5]], [[0.5, 1.5, 0.5]]]) / [[[4.5]], [[2.5]]])
    named = CategorySignal.from_samples([[[0, 0]]], categories=["a", "b"], pseudo_count=1)
    np.testing.assert_allclose(named.probs, [[[0.75, 0.25]]])


def test_table_keeps_few_categories_and_joins_many():
    np.testing.assert_allclose(CategorySignal(GOLF).table(3).probs, GOLF)
    joined = CategorySignal(GOLF).table(2).probs
    assert joined.shape == (2, 1, 2)
    # Far tells most: the first two are joined.
    np.testing.assert_allclose(joined, [[[0.9, 0.1]], [[0.3, 0.7]]])


@pytest.mark.parametrize("signal", [3, -1, "far", None, np.nan, [0], 1.5])
def test_unknown_categories_are_refused(signal):
    with pytest.raises(InputError, match="signal must be one of"):
        CategorySignal(GOLF).log_likelihood(0, signal)


def test_other_bad_input_is_refused():
    with pytest.raises(NotFoundError, match="unknown policy"):
        CategorySignal(GOLF).log_likelihood(-1, 0)
    with pytest.raises(InputError, match="distinct names"):
        CategorySignal(GOLF, ["a", "b", "b"])
    with pytest.raises(InputError, match="sum to 1"):
        CategorySignal([[[0.5, 0.6]]])
    with pytest.raises(InputError, match="rows of one length"):
        CategorySignal([[[0.5, 0.5], [1.0]]])
    with pytest.raises(InputError, match="samples must be category numbers"):
        CategorySignal.from_samples([[[0.5]]])
    with pytest.raises(InputError, match="samples must be category numbers"):
        CategorySignal.from_samples([[[4]]], n_categories=3)
    with pytest.raises(InputError, match="pseudo_count must be at least 0"):
        CategorySignal.from_samples([[[0]]], pseudo_count=-1)
