"""Bins that tell types apart: the joining against a slow twin, and what is lost of the information."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import norm

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals import normal_distribution, signal_bins
from lifelore.interaction.finite_signals.normal_distribution import ndtr
from lifelore.interaction.finite_signals.signal_bins import (
    informative_cuts,
    joined,
    joined_ends,
    normal_probs,
    normal_table,
)


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


def joined_bins(fine, n_bins):
    """Bins (P, T, n) joined, (P, T, at most n_bins)."""
    return joined(fine.transpose(1, 0, 2), joined_ends(fine, n_bins)).transpose(1, 0, 2)


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10_000), st.integers(1, 3), st.integers(1, 5), st.integers(2, 9), st.integers(1, 5))
def test_against_the_slow_twin(seed, n_policies, n_types, n_fine, n_bins):
    fine = np.random.default_rng(seed).dirichlet(np.full(n_fine, 0.7), (n_policies, n_types))
    found = joined_bins(fine, n_bins)
    assert found.shape == (n_policies, n_types, min(n_bins, n_fine))
    np.testing.assert_allclose(found.sum(axis=2), 1)
    # Equal losses may be joined in another order, and then nothing is lost by it.
    for ours, own in zip(found, fine, strict=True):
        assert information(ours) == pytest.approx(information(slow_joined(own, n_bins)), abs=1e-6)


def test_joined_bins_of_users_by_hand():
    probs = np.array([[[[0.1, 0.2, 0.3, 0.4], [0.4, 0.3, 0.2, 0.1]]], [[[0.7, 0.1, 0.1, 0.1], [0.25] * 4]]])
    found = joined(probs, np.array([[1, 4], [3, 4]]))
    np.testing.assert_allclose(found, [[[[0.1, 0.9], [0.9, 0.1]]], [[[0.7, 0.3], [0.75, 0.25]]]])


def test_policies_are_cut_as_alone_and_in_blocks_as_at_once(monkeypatch):
    random = np.random.default_rng(0)
    mean, deviation = random.normal(0, 50, (7, 5)), random.uniform(5, 30, (7, 5))
    cuts = informative_cuts(mean, deviation, 6)
    assert (np.diff(cuts, axis=1) >= 0).all()
    for policy in range(5):
        alone = informative_cuts(mean[:, [policy]], deviation[:, [policy]], 6)
        np.testing.assert_allclose(alone, cuts[[policy]], rtol=1e-12)
    monkeypatch.setattr(signal_bins, "_AT_ONCE", 1)
    np.testing.assert_allclose(informative_cuts(mean, deviation, 6), cuts, rtol=1e-12)


def test_a_table_holds_the_shares_of_normal_outcomes():
    random = np.random.default_rng(1)
    mean, deviation = random.normal(0, 50, (3, 7, 5)), random.uniform(5, 30, (3, 7, 5))
    cuts = informative_cuts(mean[0], deviation[0], 6)
    users = normal_probs(mean, deviation, cuts)
    edges = np.concatenate([np.full((5, 1), -np.inf), cuts, np.full((5, 1), np.inf)], axis=1)
    below = norm.cdf(edges, mean[..., None], deviation[..., None])
    np.testing.assert_allclose(users, np.diff(below, axis=-1), atol=1e-8)
    same, table = normal_table(mean[0], deviation[0], 6)
    assert np.array_equal(same, cuts)
    np.testing.assert_allclose(table.probs, users[0], atol=1e-8)


def test_fewer_than_two_bins_are_refused():
    with pytest.raises(InputError, match="n_bins must be at least 2, got 1"):
        informative_cuts(np.zeros((2, 1)), np.ones((2, 1)), 1)


def test_few_numbers_and_many_have_the_same_distribution_function(monkeypatch):
    z = np.concatenate([np.linspace(-38, 38, 8002), [-np.inf, np.inf]]).reshape(-1, 3)
    found = []
    for few in (1 << 30, 0):
        monkeypatch.setattr(normal_distribution, "FEW", few)
        found.append(ndtr(z))
        assert ndtr(0.0) == 0.5
        assert np.isnan(ndtr(np.nan))
    assert found[0].shape == z.shape
    np.testing.assert_allclose(found[0], found[1], rtol=1e-13, atol=1e-300)
    np.testing.assert_allclose(found[0], norm.cdf(z), rtol=1e-13, atol=1e-300)
