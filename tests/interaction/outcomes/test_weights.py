"""Reliability weights: NumPy's weighted moments as oracle, unit weights bit for bit, and clear errors."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.outcome_kinds import KINDS
from lifelore.interaction.outcomes.outcome_model import rows_of_samples


def samples(seed=0, n=7):
    values = np.random.default_rng(seed).integers(-4, 5, (3, 2, n)).astype(float)
    values[1, 0, 4:] = np.nan
    return values


def state(library):
    return {name: value.tobytes() for name, value in library.performance.to_arrays().items()}


@pytest.mark.parametrize("model", sorted(KINDS))
@pytest.mark.parametrize("weight", [1.0, 0.1, 7.3, 1e300, 1e-300])
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


def test_only_ratios_within_a_pair_count():
    random = np.random.default_rng(0)
    weights = random.uniform(0.1, 2, (3, 2, 7))
    plain = GaussianOutcomes.from_rows(rows_of_samples(samples(), weights))
    scaled = GaussianOutcomes.from_rows(rows_of_samples(samples(), weights * random.uniform(1, 9, (3, 2, 1))))
    for name, value in plain.to_arrays().items():
        np.testing.assert_allclose(scaled.to_arrays()[name], value, rtol=1e-12)


def test_a_weight_of_0_leaves_an_outcome_out():
    weights = np.ones((3, 2, 7))
    weights[:, :, 5:] = 0
    masked = np.where(weights > 0, samples(), np.nan)
    assert state(PolicyLibrary.from_samples(samples(), weights=weights)) == state(
        PolicyLibrary.from_samples(masked)
    )


def test_counts_of_categories_by_hand():
    # Weights 3 and 1: effective number 16 / 10 = 1.6, of which three quarters are of the first value.
    model = CategoricalOutcomes.from_rows(rows_of_samples([[[0.0, 1.0]]], [[[3.0, 1.0]]]))
    assert model.counts[0, 0] == pytest.approx([1.2 + 0.5, 0.4 + 0.5])


def test_weights_of_sampling_correct_a_biased_log():
    """A log with high outcomes ten times as often; weights of 1 / probability give the mean of all."""
    random = np.random.default_rng(3)
    every = random.normal(0, 1, 40_000)
    probability = np.where(every > 0, 0.5, 0.05)
    logged = random.random(len(every)) < probability
    values, weights = every[logged][None, None], 1 / probability[logged][None, None]
    plain = PolicyLibrary.from_samples(values).performance
    weighted = PolicyLibrary.from_samples(values, weights=weights).performance
    # The effective number of about 3,900 outcomes gives a deviation of the mean of 0.016; four of them.
    assert weighted.mean[0, 0] == pytest.approx(0, abs=0.064)
    assert plain.mean[0, 0] > 0.6
    assert weighted.moments.count[0, 0] < 0.4 * logged.sum()


def test_rows_and_frames_take_weights_alike():
    frame = {
        "type": ["x", "x", "y", "y"], "policy": ["a"] * 4, "outcome": [1.0, 3.0, 5.0, 9.0],
        "w": [1.0, 3.0, 1.0, 1.0],
    }  # fmt: skip
    library = PolicyLibrary.from_frame(frame, weight="w")
    assert library.performance.mean.ravel().tolist() == [2.5, 7.0]
    rows = rows_of_samples([[[1.0, 3.0]], [[5.0, 9.0]]])
    assert state(PolicyLibrary.from_rows(rows, weights=frame["w"])) == state(library)


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


def test_a_weight_that_is_missing_is_named():
    frame = {"type": ["x", "x"], "policy": ["a", "a"], "outcome": [1.0, 2.0], "w": [1.0, None]}
    with pytest.raises(InputError, match="column 'w' must be finite, row 1 is nan"):
        PolicyLibrary.from_frame(frame, weight="w")
