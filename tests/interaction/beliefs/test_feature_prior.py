"""The prior over types from features: calibrated, shrunk where rows are few, and of use in the first episodes."""

import json

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.beliefs.feature_prior import PSEUDO_ROWS, SHARE, FeaturePrior

WEIGHTS = 2 * np.random.default_rng(7).normal(size=(4, 3))


def users(n: int, seed: int, weights: np.ndarray = WEIGHTS):
    """Features, types, and the true P(type | features) of users whose types follow a logistic law."""
    random = np.random.default_rng(seed)
    features = random.normal([30, 4, 0], [10, 2, 1], (n, 3))
    logits = (features - [30, 4, 0]) / [10, 2, 1] @ weights.T
    probs = np.exp(logits - logits.max(axis=1, keepdims=True))
    probs /= probs.sum(axis=1, keepdims=True)
    return features, (probs.cumsum(axis=1) < random.random((n, 1))).sum(axis=1).clip(max=len(weights) - 1), probs


@pytest.mark.slow
@pytest.mark.parametrize("n_types", [2, 4])
def test_with_many_rows_it_is_the_true_law(n_types):
    weights = WEIGHTS[:n_types]
    features, types, _ = users(4000, 0, weights)
    found = FeaturePrior.fit(features, types, np.full(n_types, 1 / n_types))
    fresh, _, probs = users(2000, 1, weights)
    # Divergence from the truth in nats: parameters / (2 n) is 0.002, and a share of 0.01 of the library's prior.
    divergence = (probs * np.log(probs / found.prior(fresh))).sum(axis=1).mean()
    assert divergence < 0.02
    assert found.gain > 0.05
    assert found.strength > 0


@pytest.mark.parametrize("n", [1, 2, 4])
def test_few_rows_give_nearly_the_librarys_prior(n):
    features, types, _ = users(n, 4)
    prior = np.array([0.4, 0.3, 0.2, 0.1])
    found = FeaturePrior.fit(features, types, prior)
    assert found.strength == 0
    counts = np.bincount(types, minlength=4) + PSEUDO_ROWS * prior
    expected = (1 - SHARE) * counts / counts.sum() + SHARE * prior
    assert found.prior(features[0]) == pytest.approx(expected)


def test_soft_types_are_as_rows_of_each_type():
    features, types, _ = users(60, 6)
    hard = FeaturePrior.fit(features, types, np.full(4, 0.25))
    assert FeaturePrior.fit(features, np.eye(4)[types], np.full(4, 0.25)).to_dict() == hard.to_dict()
    flat = FeaturePrior.fit(features, np.full((60, 4), 0.25), np.full(4, 0.25))
    assert flat.prior(features) == pytest.approx(np.full((60, 4), 0.25), abs=1e-3)


def test_beyond_the_training_rows_it_extrapolates_no_further():
    features, types, _ = users(400, 8)
    found = FeaturePrior.fit(features, types, np.full(4, 0.25))
    far = found.prior(features.max(axis=0) + 1e9)
    assert np.array_equal(far, found.prior(features.max(axis=0)))
    assert (far >= SHARE * 0.25 - 1e-12).all()


def test_to_dict_restores_every_bit_through_json():
    features, types, _ = users(80, 11, WEIGHTS[:2])
    found = FeaturePrior.fit(features, types, [0.5, 0.5, 0.0], ["age", "visits", "x"])
    again = FeaturePrior.from_dict(json.loads(json.dumps(found.to_dict(), allow_nan=False)))
    assert np.array_equal(again.prior(features), found.prior(features))
    assert again.to_dict() == found.to_dict()
    for broken in ({}, found.to_dict() | {"weights": [[1.0]]}, found.to_dict() | {"centre": "x"}):
        with pytest.raises(InputError, match="data must be a FeaturePrior's to_dict"):
            FeaturePrior.from_dict(broken)


FITTED = FeaturePrior.fit(*users(100, 12)[:2], np.full(4, 0.25), ["age", "visits", "x"])


@pytest.mark.parametrize(
    ("features", "error", "words"),
    [
        ({"age": 3.0}, InputError, "got no visits, x; without any feature"),
        ({"age": 3.0, "visits": 1, "x": 0, "size": 2}, NotFoundError, "unknown feature 'size'; there are age"),
        ({"age": np.nan, "visits": 1, "x": 0}, InputError, "feature 'age' must be a finite number, got nan"),
        ({"age": "old", "visits": 1, "x": 0}, InputError, "feature 'age' must be a finite number, got 'old'"),
        ([1.0, 2.0], InputError, r"features must be finite numbers \(..., 3\)"),
        ([1.0, 2.0, np.inf], InputError, "features must be finite numbers"),
    ],
)
def test_bad_features_are_refused(features, error, words):
    with pytest.raises(error, match=words):
        FITTED.prior(features)


@pytest.mark.parametrize(
    ("rows", "types", "prior", "words"),
    [
        ([[1.0], [np.nan]], [0, 1], [0.5, 0.5], "row 1 is not; leave rows"),
        ([1.0, 2.0], [0, 1], [0.5, 0.5], r"\(n, n_features\)"),
        ([[1.0], [2.0]], [0, 2], [0.5, 0.5], "unknown type"),
        ([[1.0], [2.0]], [0], [0.5, 0.5], r"types must be \(2,\) numbers"),
        ([[1.0], [2.0]], [[0.5, 0.6], [1, 0]], [0.5, 0.5], "sum to 1 in each row"),
        ([[1.0], [2.0]], [0, 1], [0.5, 0.6], "library_prior must be"),
    ],
)
def test_bad_rows_are_refused(rows, types, prior, words):
    with pytest.raises((InputError, NotFoundError), match=words):
        FeaturePrior.fit(rows, types, prior)
    with pytest.raises(InputError, match="1 distinct ones"):
        FeaturePrior.fit([[1.0], [2.0]], [0, 1], [0.5, 0.5], ["a", "b"])
