"""Bins that tell types apart: the joining against a slow twin, and what is lost of the information."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.interaction.finite_signals.signal_bins import informative_cuts, joined_bins
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes


def information(probs):
    """Mutual information of type and bin, types equally likely, in nats; `probs` (n_types, n_bins)."""
    both = probs / len(probs)
    alone = both.sum(axis=0)
    terms = [
        both[i, j] * np.log(both[i, j] / (alone[j] / len(probs)))
        for i, j in np.ndindex(*probs.shape)
        if both[i, j] > 0
    ]
    return sum(terms)


def slow_joined(fine, n_bins):
    """Join the neighbours whose union keeps most information, one pair at a time."""
    while fine.shape[1] > n_bins:
        unions = [
            np.add.reduceat(fine, [i for i in range(fine.shape[1]) if i != k], axis=1)
            for k in range(1, fine.shape[1])
        ]
        fine = max(unions, key=information)
    return fine


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10_000), st.integers(1, 5), st.integers(2, 9), st.integers(2, 5))
def test_against_the_slow_twin(seed, n_types, n_fine, n_bins):
    fine = np.random.default_rng(seed).dirichlet(np.full(n_fine, 0.7), n_types)
    joined = joined_bins(fine.copy(), n_bins)
    assert joined.shape == (n_types, min(n_bins, n_fine))
    np.testing.assert_allclose(joined.sum(axis=1), 1)
    # Equal losses may be joined in another order, and then nothing is lost by it.
    assert information(joined) == pytest.approx(information(slow_joined(fine, n_bins)), abs=1e-6)


def test_bins_nobody_fills_are_joined_first():
    fine = np.array([[0.5, 0.0, 0.0, 0.5], [0.9, 0.0, 0.0, 0.1]])
    np.testing.assert_allclose(joined_bins(fine, 2), [[0.5, 0.5], [0.9, 0.1]])


def test_bins_are_not_spent_on_the_noise_of_the_many():
    """Sixty types alike and four apart: eight bins of equal mass lose what tells the four apart."""
    mean = np.r_[np.zeros(60), [140.0, 160.0, 180.0, 200.0]][:, None]
    model = GaussianOutcomes(mean, 20.0)
    every = np.linspace(-100, 300, 2001)

    def cut(cuts):
        return np.diff(model.cumulative(0, cuts), axis=1, prepend=0, append=1)

    whole = information(cut(every))
    ours = information(cut(informative_cuts(model, 0, 8)))
    drawn = np.random.default_rng(0).normal(mean, 20.0, (64, 1000))
    equal_mass = information(cut(np.quantile(drawn, np.arange(1, 8) / 8)))
    assert ours > 0.95 * whole
    assert equal_mass < 0.75 * whole
    assert ours <= whole


def test_identical_types_give_a_table_all_the_same():
    table = GaussianOutcomes([[1.0], [1.0], [1.0]], 2.0).table()
    assert (table.probs[0] == table.probs[0, 0]).all()


def test_many_types_are_cut_on_some_of_them():
    mean = np.random.default_rng(0).normal(0, 50, (400, 1))
    few, many = GaussianOutcomes(mean[:100], 20.0), GaussianOutcomes(mean, 20.0)
    assert many.table(6).probs.shape == (1, 400, 6)
    shares = [
        information(model.table(6).probs[0]) / information(model.table(60).probs[0]) for model in (few, many)
    ]
    # A hundred are all looked at, of four hundred only some: hardly worse.
    assert shares[1] > shares[0] - 0.03 > 0.8


def test_any_number_of_bins_may_be_asked_for():
    model = GaussianOutcomes([[0.0], [1.0]], 1.0)
    for n_bins, found in itertools.product([2, 3, 300], [model]):
        table = found.table(n_bins)
        assert table.n_signals == n_bins
        np.testing.assert_allclose(table.probs.sum(axis=2), 1)
