"""The belief over types and the parameters of their models, beside direct computations."""

from typing import Any

import numpy as np
import pytest
from scipy import stats

from lifelore.core.errors import InputError
from lifelore.interaction import BayesianPolicyReuse, ExpectedImprovement, Greedy, PolicyLibrary, TypeDynamics
from lifelore.interaction.outcomes.spread import Spread

from ..twins.naive_models import NormalPair, normal_moments, over_spreads

STATIC = TypeDynamics.static()


def learnt(n_types=4, n_policies=3, spread=0.0, seed=0) -> PolicyLibrary:
    """A library of six runs of each pair and a known spread."""
    random = np.random.default_rng(seed)
    mean = random.normal(scale=30, size=(n_types, n_policies, 1))
    library = PolicyLibrary.from_samples(mean + random.normal(scale=10, size=(n_types, n_policies, 6)))
    library.performance.spread = Spread.known(spread)
    return library


def predicted(agent: BayesianPolicyReuse) -> Any:
    """The next outcomes, given what the agent's task has shown."""
    return agent.algorithm.known(0).performance


def test_moments_are_those_of_integrating_over_spreads_means_and_variances():
    library = learnt()
    library.performance.spread = Spread.up_to(0.6)
    agent = BayesianPolicyReuse(library, Greedy(), dynamics=STATIC)
    shown = {0: [12.0, 20.0, 15.0], 2: [-5.0]}
    for policy, outcomes in shown.items():
        for outcome in outcomes:
            agent.update(policy, outcome)
    weights, found = np.exp(agent.algorithm.outcomes.log_weights[0]).tolist(), predicted(agent)
    moments = library.performance.moments
    for pair in np.ndindex(moments.mean.shape):
        law = NormalPair(
            *(field[pair] for field in (moments.mean, moments.variance, moments.count, moments.freedom))
        )
        earlier = [(outcome, 1.0) for outcome in shown.get(pair[1], [])]
        expected = over_spreads([normal_moments(law, rho, earlier) for rho in Spread.up_to(0.6).values], weights)
        assert found.mean[pair] == pytest.approx(expected.mean, rel=1e-6)
        assert found.mean_variance[pair] == pytest.approx(expected.mean_variance, rel=1e-6)
        assert found.deviation[pair] ** 2 == pytest.approx(expected.mean_variance + expected.noise, rel=1e-6)


def test_a_users_table_has_the_librarys_bins():
    """Bins are where the cumulative probabilities of a normal say; what a user shows moves no cut."""
    agent = BayesianPolicyReuse(learnt(spread=0.4), Greedy(), dynamics=STATIC)
    before = agent.algorithm.known(0).table(6).probs
    cuts = [cuts_of(agent, before)]
    agent.update(1, 8.0)
    after = agent.algorithm.known(0).table(6).probs
    cuts.append(cuts_of(agent, after))
    assert (after[:, 1] != before[:, 1]).any()
    assert np.array_equal(after[:, [0, 2]], before[:, [0, 2]])
    assert np.isfinite(cuts).all(axis=0).sum() > 5
    assert cuts[1] - cuts[0] == pytest.approx(np.zeros((4, 5)), abs=0.01, nan_ok=True)


def cuts_of(agent: BayesianPolicyReuse, probs: np.ndarray) -> np.ndarray:
    """Cut points of policy 1 that each type's probabilities of bins imply, NaN where these are too near 0 or 1."""
    outcomes, below = predicted(agent), probs[:, 1].cumsum(axis=1)[:, :-1]
    quantiles = stats.norm.ppf(np.where(np.abs(below - 0.5) < 0.5 - 1e-4, below, np.nan))
    return outcomes.mean[:, 1, None] + outcomes.deviation[:, 1, None] * quantiles


def test_a_task_teaches_the_library_once():
    library = learnt(2, 2)
    samples = [30.0, 31.0, 28.0]
    agent = BayesianPolicyReuse(library, prior=[1.0, 0.0], dynamics=STATIC)
    by_hand = learnt(2, 2)
    for outcome in samples:
        agent.update(1, outcome)
        by_hand.observe(0, 1, outcome)
    assert agent.teach() == "type 0"
    for field in ("mean", "variance", "count", "freedom"):
        assert getattr(library.performance.moments, field) == pytest.approx(
            getattr(by_hand.performance.moments, field)
        )
    with pytest.raises(InputError, match="taught the library before"):
        agent.teach()
    assert BayesianPolicyReuse(learnt(2, 2)).teach() is None, "the type is not known"


def test_no_update_makes_numbers_that_are_none():
    """Extreme outcomes, single runs, exact pairs among learnt pairs."""
    library = PolicyLibrary.from_means(
        [[0.0, 1e90], [5.0, -3.0]], [[1e-40, 1.0], [1e40, 2.0]], count=[[1.0, np.inf], [3.0, 1e6]]
    )
    random = np.random.default_rng(0)
    agent = BayesianPolicyReuse(library, ExpectedImprovement(), dynamics=TypeDynamics.hazard(0.1, library.prior))
    for _ in range(400):
        agent.update(int(random.integers(2)), float(random.choice([1e100, -1e100, 0.0, 1e-300, 5.0])))
        assert not np.isnan(agent.log_belief).any()
        assert np.exp(agent.log_belief).sum() == pytest.approx(1)
        assert not np.isnan(agent.expected_utility()).any()


def test_the_excess_of_means_is_that_of_normals():
    agent = BayesianPolicyReuse(learnt(), ExpectedImprovement(), dynamics=TypeDynamics.static())
    for policy, value in ((0, 3.0), (1, -2.0), (0, 4.0)):
        agent.update(policy, value)
    model = predicted(agent)
    deviation = np.sqrt(model.mean_variance)
    for threshold in (-100.0, 0.0, 3.0, 100.0):
        z = (model.mean - threshold) / deviation
        exact = deviation * stats.norm.pdf(z) + (model.mean - threshold) * stats.norm.cdf(z)
        assert model.expected_mean_excess(threshold) == pytest.approx(exact, rel=1e-9, abs=1e-20)
