"""Bayes' rule and a hazard's step in one pass: against the two steps apart, and compiled against plain NumPy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.interaction.beliefs.bayes_rule import bayes_rule
from lifelore.interaction.beliefs.hazard import LEAST_ANEW, HazardTerms, hazard_rule, log_of_sum, logarithms
from lifelore.interaction.beliefs.hazard_kernels import hazard_row
from lifelore.interaction.beliefs.type_dynamics import DEFAULT_HAZARD, TypeDynamics


@settings(deadline=None, max_examples=200)
@given(st.integers(0, 2**32 - 1), st.sampled_from([DEFAULT_HAZARD, 0.3, 1.0, 1e-12, 1e-295]))
def test_one_pass_is_bayes_rule_and_then_the_step(seed, rate):
    random = np.random.default_rng(seed)
    n = int(random.integers(1, 12))
    prior = random.dirichlet(np.full(n, 0.2))
    prior[random.random(n) < 0.2] = 0
    prior = prior / prior.sum() if prior.sum() else np.full(n, 1 / n)
    with np.errstate(divide="ignore"):
        log_belief = np.log(random.dirichlet(np.full(n, 0.3)))
    log_belief -= np.log(np.exp(log_belief).sum())
    log_likelihood = random.normal(scale=10.0 ** random.integers(0, 4), size=n)
    log_likelihood[random.random(n) < 0.2] = -np.inf
    dynamics = TypeDynamics.hazard(rate, prior)
    terms = dynamics.hazard_terms()
    assert terms is not None
    after, evidence = hazard_rule(log_belief, log_likelihood, terms)
    learnt, same_evidence = bayes_rule(log_belief, log_likelihood)
    assert evidence == same_evidence
    apart = dynamics.step(learnt)
    assert after == pytest.approx(apart, rel=1e-12, abs=1e-15)
    compiled = log_belief.copy()
    assert hazard_row(compiled, log_likelihood, terms) == evidence
    assert compiled.tobytes() == after.tobytes()


def test_logarithms_are_exact_to_a_unit_in_the_last_place():
    values = 10.0 ** np.random.default_rng(0).uniform(-289, 0, 100_000)
    assert logarithms(values) == pytest.approx(np.log(values), rel=2.3e-16, abs=0)
    assert logarithms(np.array([1.0, 0.5, 2.0**-900])).tolist() == [0.0, np.log(0.5), np.log(2.0**-900)]


def test_a_sum_of_two_logarithms():
    assert log_of_sum(np.log(0.25), np.log(0.5)) == pytest.approx(np.log(0.75))
    assert log_of_sum(-800.0, -np.inf) == log_of_sum(-np.inf, -800.0) == -800.0
    assert log_of_sum(-np.inf, -np.inf) == -np.inf


def test_a_likelihood_that_is_no_number_leaves_the_belief():
    terms = HazardTerms.of(0.1, np.array([0.5, 0.5]))
    before = np.log([0.25, 0.75])
    for bad in (np.nan, np.inf):
        row = before.copy()
        assert np.isnan(hazard_row(row, np.array([0.0, bad]), terms))
        after, evidence = hazard_rule(row, np.array([0.0, bad]), terms)
        assert np.isnan(evidence)
        assert row.tolist() == after.tolist() == before.tolist()


def test_types_with_little_of_the_prior_are_named():
    prior = np.array([1.0 - 1e-10, 1e-10, 0.0])
    assert HazardTerms.of(0.1, prior).small.tolist() == [2]
    assert HazardTerms.of(LEAST_ANEW["f4"] * 1e5, prior, "f4").small.tolist() == [1, 2]
    assert HazardTerms.of(0.1, prior, "f4").anew.dtype == np.float32
    assert TypeDynamics.static().hazard_terms() is TypeDynamics.hazard(0.0, prior).hazard_terms() is None
