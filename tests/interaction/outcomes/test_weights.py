"""Reliability weights: NumPy's weighted moments as oracle, unit weights bit for bit, and clear errors."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.outcome_kinds import KINDS


def samples(seed=0, n=7):
    values = np.random.default_rng(seed).integers(-4, 5, (3, 2, n)).astype(float)
    values[1, 0, 4:] = np.nan
    return values


def state(library):
    return {name: value.tobytes() for name, value in library.performance.to_arrays().items()}


@pytest.mark.parametrize("model", sorted(KINDS))
@pytest.mark.parametrize("weight", [1.0, 7.3, 1e300])
def test_equal_weights_give_the_bits_of_none(model, weight):
    plain = PolicyLibrary.from_samples(samples(), model=model)
    weighted = PolicyLibrary.from_samples(samples(), model=model, weights=np.full((3, 2, 7), weight))
    assert state(plain) == state(weighted)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 10_000), st.integers(2, 12))
def test_a_pairs_moments_are_numpys_weighted_ones(seed, n):
    random = np.random.default_rng(seed)
    values, weights = random.normal(3, 2, n), random.gamma(0.5, size=n) + 1e-6
    model = PolicyLibrary.from_samples(values[None, None], weights=weights[None, None]).performance
    assert model.mean[0, 0] == pytest.approx(np.average(values, weights=weights))
    # NumPy's `aweights` are reliability weights. A single pair's variance is shrunk towards itself.
    assert model.deviation[0, 0] ** 2 == pytest.approx(np.cov(values, aweights=weights))
    assert model.moments.count[0, 0] == pytest.approx(weights.sum() ** 2 / (weights**2).sum())
    assert model.moments.freedom[0, 0] == pytest.approx(5 + model.moments.count[0, 0] - 1)


def test_a_weight_of_0_leaves_an_outcome_out():
    weights = np.ones((3, 2, 7))
    weights[:, :, 5:] = 0
    masked = np.where(weights > 0, samples(), np.nan)
    assert state(PolicyLibrary.from_samples(samples(), weights=weights)) == state(
        PolicyLibrary.from_samples(masked)
    )


@pytest.mark.parametrize(
    ("weights", "words"),
    [
        (np.ones((3, 2)), "the shape of samples"),
        (np.full((3, 2, 7), -1.0), "at least 0 and finite"),
        (np.full((3, 2, 7), np.nan), "at least 0 and finite"),
        (np.full((3, 2, 7), np.inf), "at least 0 and finite"),
        (np.zeros((3, 2, 7)), "every pair of type and policy needs a sample"),
        (np.full((3, 2, 7), "heavy"), "weights must be numbers"),
    ],
)
def test_bad_weights_are_refused(weights, words):
    with pytest.raises(InputError, match=words):
        PolicyLibrary.from_samples(samples(), weights=weights)
