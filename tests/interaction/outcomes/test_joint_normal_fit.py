"""The fit of joint-normal outcomes beside a step in plain loops, and on simulated users."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from lifelore.interaction.outcomes.joint_normal_fit import PSEUDO, UserMeans, first_fit, joint_normal_fit, step
from lifelore.interaction.outcomes.outcome_rows import OutcomeRows

FACTORS = np.array([[0.9, 0.0], [0.8, 0.1], [0.0, 0.9], [0.2, -0.8], [0.5, 0.5]])
COVARIANCE = FACTORS @ FACTORS.T + 0.1 * np.eye(5)
MEAN = np.array([[0.0, 0.5, 1.0, -0.5, 0.2], [3.0, -2.0, 0.0, 1.0, -3.0]])


def simulated(seed, n_users, each, noise=0.6, n_types=1):
    """Outcomes of users with `each` policies drawn at random, and their types."""
    random = np.random.default_rng(seed)
    types = random.integers(n_types, size=n_users)
    u = MEAN[types] + random.multivariate_normal(np.zeros(5), COVARIANCE, size=n_users)
    users, policies = np.repeat(np.arange(n_users), each), random.integers(5, size=n_users * each)
    values = u[users, policies] + random.normal(scale=noise, size=users.size)
    return OutcomeRows(users, policies, values, (n_users, 5)), types


def naive_log_likelihood(rows, user, mean, covariance, noise):
    """Log density of all outcomes of a user, W and the weights of outcomes in means by the whole covariance."""
    own = rows.types == user
    policies, values = rows.policies[own], rows.values[own]
    whole = covariance[np.ix_(policies, policies)] + np.diag(noise[policies] ** 2)
    return multivariate_normal(mean[policies], whole).logpdf(values), np.linalg.inv(whole), policies, values


def naive_step(rows, fit):
    """A step of expectation–maximisation over single outcomes, in loops."""
    model, n_users, n_types = fit.model, rows.shape[0], len(fit.weights)
    covariance, noise, whole_mean = model.covariance, model.noise, UserMeans.of(rows).of_all
    probs, likelihood = np.zeros((n_users, n_types)), 0.0
    for user in range(n_users):
        logs = [naive_log_likelihood(rows, user, mean, covariance, noise)[0] for mean in model.mean]
        joint = fit.weights * np.exp(logs)
        probs[user], likelihood = joint / joint.sum(), likelihood + np.log(joint.sum())
    means = np.zeros_like(model.mean)
    for type_ in range(n_types):
        precision = np.diag(PSEUDO / (np.diag(covariance) + noise**2))
        told = precision @ whole_mean
        for user in range(n_users):
            _, inverse, policies, values = naive_log_likelihood(rows, user, means[0], covariance, noise)
            design = np.eye(5)[policies]
            precision = precision + probs[user, type_] * design.T @ inverse @ design
            told = told + probs[user, type_] * design.T @ inverse @ values
        means[type_] = np.linalg.solve(precision, told)
    moments, squares, number = np.zeros((5, 5)), np.zeros(5), np.zeros(5)
    for user in range(n_users):
        for type_, share in enumerate(probs[user]):
            _, inverse, policies, values = naive_log_likelihood(rows, user, means[type_], covariance, noise)
            told = covariance[:, policies] @ inverse
            gap = told @ (values - means[type_, policies])
            unsure = covariance - told @ covariance[policies]
            moments += share * (np.outer(gap, gap) + unsure)
            for policy, value in zip(policies, values, strict=True):
                left = (value - means[type_, policy] - gap[policy]) ** 2 + unsure[policy, policy]
                squares[policy] += share * left
                number[policy] += share
    found = moments / n_users
    found = (n_users * found + fit.shrinkage * np.diag(np.diag(found))) / (n_users + fit.shrinkage)
    pooled = squares.sum() / number.sum()
    return means, found, np.sqrt((squares + PSEUDO * pooled) / (number + PSEUDO)), probs, likelihood


def test_a_step_is_that_of_plain_loops():
    rows, _ = simulated(0, 12, 4, n_types=2)
    probs = np.random.default_rng(1).dirichlet([1.0, 1.0], size=12)
    fit = step(UserMeans.of(rows), first_fit(UserMeans.of(rows), probs, 3.0))
    for _ in range(2):
        mean, covariance, noise, probs, likelihood = naive_step(rows, fit)
        fit = step(UserMeans.of(rows), fit)
        assert fit.model.mean == pytest.approx(mean)
        assert fit.model.covariance == pytest.approx(covariance)
        assert fit.model.noise == pytest.approx(noise)
        assert fit.probs == pytest.approx(probs)
        assert fit.log_likelihood == pytest.approx(likelihood)


def test_many_users_give_back_their_covariance():
    rows, _ = simulated(2, 3000, 8)
    fit = joint_normal_fit(rows)
    # A covariance of 3,000 users has standard errors of about √(2 / 3000) = 0.026 of variances near 1; outcomes
    # are noisy and partial, so three times that with margin.
    assert fit.model.covariance == pytest.approx(COVARIANCE, abs=0.1)
    assert fit.model.mean[0] == pytest.approx(MEAN[0], abs=0.1)
    assert fit.model.noise == pytest.approx(0.6, abs=0.05)
    assert fit.shrinkage <= 5


def test_types_with_shared_items_are_both_found():
    rows, types = simulated(3, 600, 8, n_types=2)
    start = np.where((types == 0)[:, None], [0.6, 0.4], [0.4, 0.6])
    fit = joint_normal_fit(rows, start)
    assert fit.model.mean == pytest.approx(MEAN, abs=0.2)
    assert fit.weights == pytest.approx([0.5, 0.5], abs=0.06)
    assert (fit.probs.argmax(axis=1) == types).mean() > 0.95
    assert fit.model.covariance == pytest.approx(COVARIANCE, abs=0.2)
