"""The joint-normal law beside conditioning by the inverse of the whole covariance of all outcomes."""

from typing import Any

import numpy as np
import pytest
from scipy.stats import multivariate_normal, norm

from lifelore.core.errors import InputError
from lifelore.interaction import JointNormalOutcomes, PolicyLibrary, TypeDynamics, UserBeliefs
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm

MEAN = np.array([[1.0, 4.0, -2.0, 30.0], [3.0, 0.0, 2.0, 28.0]])
FACTORS = np.array([[1.0, 0.5], [0.8, -0.3], [-0.6, 1.0], [2.0, 3.0]])
COVARIANCE = FACTORS @ FACTORS.T
"""Of rank 2: singular."""
DEVIATION = np.array([0.7, 1.0, 0.5, 4.0])
SHOWN = [(0, 2.5), (3, 25.0), (0, 1.5), (2, 0.5), (0, 3.0)]
PRIOR = np.array([0.3, 0.7])


def law(dtype: str = "f8") -> Any:
    return JointNormalOutcomes(MEAN, COVARIANCE, DEVIATION).law(dtype=dtype)


def conditioned(shown, type_):
    """Mean and covariance of u given all outcomes: the outcomes and u are normal together."""
    if not shown:
        return MEAN[type_], COVARIANCE
    policies, values = np.array([p for p, _ in shown]), np.array([x for _, x in shown])
    of_outcomes = COVARIANCE[np.ix_(policies, policies)] + np.diag(DEVIATION[policies] ** 2)
    with_u = COVARIANCE[:, policies]
    told = with_u @ np.linalg.inv(of_outcomes)
    return MEAN[type_] + told @ (values - MEAN[type_, policies]), COVARIANCE - told @ with_u.T


def log_joint(shown, type_):
    """Log density of all outcomes on a type."""
    policies, values = [p for p, _ in shown], [x for _, x in shown]
    covariance = COVARIANCE[np.ix_(policies, policies)] + np.diag(DEVIATION[policies] ** 2)
    return multivariate_normal(MEAN[type_, policies], covariance).logpdf(values)


def users_of(law):
    """Three users: one who showed all outcomes, one the first two, one nothing."""
    shown = law.shown(3)
    for number, (policy, value) in enumerate(SHOWN):
        law.learn(shown, np.arange(2 if number < 2 else 1), policy, np.full(2 if number < 2 else 1, value))
    return shown, [SHOWN, SHOWN[:2], []]


def test_predictions_are_those_of_conditioning_on_all_outcomes():
    shown, each = users_of(law())
    found = law().prediction(shown, np.arange(3), np.zeros((3, 1)))
    for user, own in enumerate(each):
        single = law().prediction(shown, user, np.zeros(1))
        for type_ in range(2):
            mean, covariance = conditioned(own, type_)
            assert found.mean[user, type_] == pytest.approx(mean)
            assert found.mean_variance[user, type_] == pytest.approx(np.diag(covariance))
            assert found.deviation[user, type_] ** 2 == pytest.approx(np.diag(covariance) + DEVIATION**2)
            assert single.mean[type_] == pytest.approx(mean)
            assert single.mean_on(type_) == pytest.approx(mean)
    assert found.mean_on(np.array([1, 0, 1])) == pytest.approx(found.mean[[0, 1, 2], [1, 0, 1]])
    belief = np.array([[0.2, 0.8]] * 3)
    assert found.expected(belief) == pytest.approx(np.einsum("kt,ktp->kp", belief, found.mean))


def test_algorithm_7_has_the_posterior_of_all_outcomes():
    library = PolicyLibrary(JointNormalOutcomes(MEAN, COVARIANCE, DEVIATION), prior=PRIOR)
    algorithm = ReuseAlgorithm(library, 1, dynamics=TypeDynamics.static())
    for policy, value in SHOWN:
        algorithm.update(0, policy, value)
    joint = PRIOR * np.exp([log_joint(SHOWN, type_) for type_ in range(2)])
    assert algorithm.belief(0) == pytest.approx(joint / joint.sum())


def test_fading_counts_outcomes_by_a_share():
    shown, _ = users_of(law())
    law().fade(shown, np.array([0, 1]), np.array([0.0, 1.0]))
    found = law().prediction(shown, np.array([0, 1]), np.zeros((2, 1)))
    assert found.mean[0] == pytest.approx(MEAN)
    assert found.mean[1, 0] == pytest.approx(conditioned(SHOWN[:2], 0)[0])
    # Half of two equal outcomes is one of them.
    twice, once = law().shown(1), law().shown(1)
    for _ in range(2):
        law().learn(twice, 0, 1, 5.0)
    law().learn(once, 0, 1, 5.0)
    law().fade(twice, 0, 0.5)
    both = [law().prediction(each, 0, np.zeros(1)).mean for each in (twice, once)]
    assert both[0] == pytest.approx(both[1])


def test_tables_are_probabilities_of_bins_that_all_users_share():
    shown, each = users_of(law())
    own = law()
    found = own.prediction(shown, np.arange(3), np.zeros((3, 1))).table(5)
    single = own.prediction(shown, 0, np.zeros(1)).table(5)
    assert found.probs.shape == (3, 2, 4, 5)
    assert single.probs == pytest.approx(found.probs[0])
    cuts = own.cuts(5)
    mean, covariance = conditioned(each[0], 1)
    deviation = np.sqrt(np.diag(covariance) + DEVIATION**2)
    below = norm.cdf(cuts[2], mean[2], deviation[2])
    assert found.probs[0, 1, 2] == pytest.approx(np.diff(below, prepend=0, append=1), abs=1e-8)


def test_a_state_is_restored():
    shown, _ = users_of(law())
    state = law().state(shown, 0)
    assert state["places"].tolist() == [[0], [2], [3]]
    again = law().shown(2)
    law().restore(again, 1, state)
    assert np.array_equal(again[1], shown[0])
    with pytest.raises(InputError, match="begin a new session"):
        law().restore(shown, 0, {"policies": [0], "shown": [[1.0, 2.0]]})


def test_many_users_in_blocks_are_the_same_as_each_alone(monkeypatch):
    library = PolicyLibrary(JointNormalOutcomes(MEAN, COVARIANCE, DEVIATION), prior=PRIOR)
    random = np.random.default_rng(0)
    beliefs = UserBeliefs(library, 20, "f8", seed=0)
    alone = [UserBeliefs(library, 1, "f8", seed=0) for _ in range(20)]
    for _ in range(5):
        users = random.permutation(20)[:13]
        policies, values = random.integers(4, size=13), random.normal(0, 5, 13)
        beliefs.update(users, policies, values)
        for user, policy, value in zip(users, policies, values, strict=True):
            alone[user].update([0], [policy], [value])
    single = UserBeliefs(library, 20, "f4", seed=0)
    single.algorithm.unpack(np.arange(20), beliefs.algorithm.packed(np.arange(20)))
    near = single.algorithm.known(np.arange(20)).performance.mean
    assert near == pytest.approx(beliefs.algorithm.known(np.arange(20)).performance.mean, rel=1e-5, abs=1e-5)
    monkeypatch.setattr("lifelore.interaction.outcomes.joint_normal_law.AT_ONCE", 50)
    found = beliefs.algorithm.known(np.arange(20)).performance.mean
    for user, one in enumerate(alone):
        assert found[user] == pytest.approx(one.algorithm.known(0).performance.mean)
        assert beliefs.log_belief[user] == pytest.approx(one.log_belief[0])
    for rule in ("greedy", "sampling", "information-directed", "knowledge-gradient", "expected-improvement"):
        assert beliefs.select(np.arange(20), rule).shape == (20,)
