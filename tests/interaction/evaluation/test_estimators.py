"""Off-policy estimators: by hand, against plain loops, against other libraries, and in closed form."""

import math

import numpy as np
import pytest
from scipy.special import stdtrit

from lifelore.core.errors import InputError
from lifelore.interaction.evaluation.estimators import (
    doubly_robust,
    inverse_propensity,
    logged_value,
    self_normalised,
)
from lifelore.interaction.evaluation.propensity_weights import importance_weights


def case(seed, n=120, n_policies=4):
    """Outcomes, users, policies, their logged probability, the target's probabilities and a model of outcomes."""
    generator = np.random.default_rng(seed)
    probs, target = generator.dirichlet(np.ones(n_policies), n), generator.dirichlet(np.full(n_policies, 0.3), n)
    policies = np.array([generator.choice(n_policies, p=row) for row in probs])
    model, users = generator.normal(size=(n, n_policies)), generator.integers(0, n // 3, n)
    return generator.normal(size=n), users, policies, probs[np.arange(n), policies], target, model


def test_by_hand():
    outcomes, weights, users = [1.0, 0.0, 2.0, 1.0], [2.0, 2.0, 0.0, 4.0], ["x", "x", "y", "z"]
    found = inverse_propensity(outcomes, weights, users)
    assert (found.value, found.n_users, found.n_decisions) == (1.5, 3, 4)
    # (w y − 1.5) / 4: x (0.5 − 1.5) / 4, y −1.5 / 4, z 2.5 / 4.
    assert found.influence.tolist() == [-0.25, -0.375, 0.625]
    error = math.sqrt(1.5 * (0.25**2 + 0.375**2 + 0.625**2))
    assert found.standard_error == pytest.approx(error)
    fourth, square = 0.25**4 + 0.375**4 + 0.625**4, 0.25**2 + 0.375**2 + 0.625**2
    freedom = min(2 / (fourth / square**2 - 1 / 3), 2)
    assert found.ci95 == pytest.approx(
        (1.5 - stdtrit(freedom, 0.975) * error, 1.5 + stdtrit(freedom, 0.975) * error)
    )
    assert self_normalised(outcomes, weights, users).value == 6 / 8
    robust = doubly_robust(outcomes, weights, [0.5, 0.5, 1.0, 1.0], [1.0, 1.0, 1.0, 0.0], users)
    assert robust.value == ((1 + 1) + (1 - 1) + 1 + 0) / 4


def test_the_interval_of_plain_means_is_students():
    """With weights 1 and users of one decision, the standard error is the usual one."""
    values = np.random.default_rng(0).normal(size=50)
    found = logged_value(values, np.arange(50))
    assert found.standard_error == pytest.approx(values.std(ddof=1) / math.sqrt(50))
    assert inverse_propensity(values, np.ones(50), np.arange(50)).ci95 == found.ci95
    assert self_normalised(values, np.ones(50), np.arange(50)).value == pytest.approx(found.value)


def test_self_normalised_contributions_are_the_jackknife():
    outcomes, users, policies, logged, target, _ = case(3)
    weights = importance_weights(target[np.arange(len(users)), policies], logged)
    found = self_normalised(outcomes, weights, users)
    left_out = [
        found.value - (weights * outcomes)[users != user].sum() / weights[users != user].sum()
        for user in np.unique(users)
    ]
    assert found.influence == pytest.approx(left_out, rel=1e-9, abs=1e-12)


def test_steps_are_normalised_each_on_its_own():
    outcomes, weights = np.array([1.0, 5.0, 3.0, 7.0, 2.0]), np.array([1.0, 0.5, 3.0, 0.5, 1.0])
    steps, users = np.array([0, 1, 0, 1, 0]), np.array([0, 0, 1, 1, 2])
    expected = (3 * (1 + 9 + 2) / 5 + 2 * (2.5 + 3.5) / 1) / 5
    assert self_normalised(outcomes, weights, users, steps).value == pytest.approx(expected)
    with pytest.raises(InputError, match="weights of each step must have a sum above 0"):
        self_normalised(outcomes, weights * (steps == 0), users, steps)


@pytest.mark.parametrize("seed", range(3))
def test_against_vowpal_wabbits_estimators(seed):
    """IPS and self-normalised IPS; with users of one decision also the standard error."""
    ips = pytest.importorskip("estimators.bandits.ips")
    snips = pytest.importorskip("estimators.bandits.snips")
    gaussian = pytest.importorskip("estimators.bandits.gaussian")
    outcomes, users, policies, logged, target, _ = case(seed)
    chosen = target[np.arange(len(users)), policies]
    weights = importance_weights(chosen, logged)
    peers = ips.Estimator(), snips.Estimator(), gaussian.Interval()
    for row in zip(logged, outcomes, chosen, strict=True):
        for peer in peers:
            peer.add_example(*map(float, row))
    assert inverse_propensity(outcomes, weights, users).value == pytest.approx(peers[0].get(), rel=1e-12)
    assert self_normalised(outcomes, weights, users).value == pytest.approx(peers[1].get(), rel=1e-12)
    low, high = peers[2].get()
    error = inverse_propensity(outcomes, weights, np.arange(len(users))).standard_error
    assert error == pytest.approx((high - low) / 2 / 1.959963984540054, rel=1e-12)


def test_a_difference_uses_that_the_users_are_the_same():
    generator = np.random.default_rng(0)
    users, base = np.arange(300) // 3, generator.normal(size=300)
    first, second = logged_value(base + 1, users), logged_value(base, users)
    assert first.minus(second).value == pytest.approx(1)
    assert first.minus(second).standard_error == pytest.approx(0, abs=1e-12)
    with pytest.raises(InputError, match="same users, got 100 and 300"):
        first.minus(logged_value(base, np.arange(300)))


def test_without_users_or_spread_there_is_no_interval():
    assert logged_value([1.0, 2.0], [0, 1]).ci95 is None
    assert logged_value([2.0, 2.0, 2.0], [0, 1, 2]).ci95 is None
    # A single user with all the weight: nothing is known of the spread between users.
    assert self_normalised([1.0, 2.0, 5.0], [0.0, 3.0, 0.0], [0, 1, 2]).ci95 is None


@pytest.mark.parametrize(
    ("outcomes", "users", "words"),
    [
        ([], [], "n at least 1"),
        ([1.0, 2.0], [0], "must be"),
        ([1.0, np.nan], [0, 1], "outcomes must be finite, got nan in row 1; leave such rows out"),
        ([[1.0]], [0], "must be"),
    ],
)
def test_bad_arrays_are_refused(outcomes, users, words):
    with pytest.raises(InputError, match=words):
        logged_value(outcomes, users)
