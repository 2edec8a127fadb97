"""The belief over types and the parameters of their models, beside direct computations."""

from typing import Any

import numpy as np
import pytest
from scipy import stats

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.normal_law import log_t_height
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection import ExpectedImprovement, Greedy
from lifelore.interaction.signals.category_signal import CategorySignal

from ..twins.naive_models import NormalPair, category_predictive, normal_moments, over_spreads

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


def test_means_are_those_of_the_conjugate_law():
    library = learnt(spread=0.5)
    moments, shown = library.performance.moments, np.array([3.0, 9.0, 4.0])
    agent = BayesianPolicyReuse(library, Greedy(), dynamics=STATIC)
    for outcome in shown:
        agent.update(1, outcome)
    weight = 1 / (1 / moments.count[:, 1] + 0.5)
    mean = (weight * moments.mean[:, 1] + shown.sum()) / (weight + 3)
    assert predicted(agent).mean[:, 1] == pytest.approx(mean)
    untried = [0, 2]
    assert np.array_equal(predicted(agent).mean[:, untried], moments.mean[:, untried])
    assert agent.expected_utility() == pytest.approx(agent.belief @ predicted(agent).mean)


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


def test_a_users_table_of_categories_is_that_of_urns():
    signal = CategorySignal(np.random.default_rng(0).dirichlet(np.ones(3), (2, 2)), count=5)
    library = PolicyLibrary(learnt(2, 2).performance, signal)
    agent = BayesianPolicyReuse(library, Greedy(), dynamics=STATIC)
    for category in (2, 0, 2):
        agent.update(1, category)
    law, table = agent.algorithm.signals.law, agent.algorithm.known(0).table(3)
    weights, earlier = np.exp(agent.algorithm.signals.log_weights[0]), [(2, 1.0), (0, 1.0), (2, 1.0)]
    assert len(weights) > 1
    for type_ in range(2):
        counts = (5 * signal.probs[type_, 1]).tolist()
        urns = [
            [np.exp(category_predictive(counts, rho, earlier, c)) for c in range(3)] for rho in law.spread.values
        ]
        assert table.probs[type_, 1] == pytest.approx(weights @ np.array(urns), rel=1e-9)
    assert table.probs[:, 0] == pytest.approx(signal.probs[:, 0], rel=1e-9)


def test_many_runs_approach_the_plug_in_model():
    library = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 2.0, count=1e9)
    library.performance.moments.spread = Spread.known(0.0)
    both = [BayesianPolicyReuse(library, models=models) for models in ("uncertain", "plug-in")]
    for agent in both:
        agent.update(0, 6.0)
        agent.update(1, 4.5)
    assert both[0].belief == pytest.approx(both[1].belief, rel=1e-6)


def test_a_wrong_model_is_unlearnt_at_the_task_itself():
    """Ten runs overestimated policy 0 of the only type: plug-in stays with it for ever, the default leaves it."""
    library = PolicyLibrary.from_means([[20.0, 15.0]], 10.0, count=10)
    chosen = {}
    for models in ("uncertain", "plug-in"):
        agent, random = BayesianPolicyReuse(library, Greedy(), models=models), np.random.default_rng(0)
        for _ in range(100):
            policy = agent.select()
            agent.update(policy, random.normal([5.0, 15.0][policy], 10.0))
        chosen[models] = agent.select()
    assert chosen == {"uncertain": 1, "plug-in": 0}


def test_dirichlet_counts_are_those_of_polya_urns():
    values = [0.0, 1.0, 5.0]
    samples = np.random.default_rng(0).choice(values, size=(3, 2, 8))
    library = PolicyLibrary.from_samples(samples, model="categorical", values=values)
    library.performance.spread = Spread.known(0.0)
    agent, shown = BayesianPolicyReuse(library, Greedy(), dynamics=STATIC), [0, 2, 2, 1]
    evidence = np.ones(3)
    counts = library.performance.counts[:, 1].copy()
    for cell in shown:
        agent.update(1, values[cell])
        evidence *= counts[:, cell] / counts.sum(axis=1)
        counts[:, cell] += 1
    assert agent.belief == pytest.approx(evidence / evidence.sum(), rel=1e-10)
    probs, found = counts / counts.sum(axis=1, keepdims=True), predicted(agent)
    mean, within = probs @ values, probs @ np.square(values) - (probs @ values) ** 2
    assert found.mean[:, 1] == pytest.approx(mean)
    assert found.deviation[:, 1] == pytest.approx(np.sqrt(within))
    # The variance of a mean under a Dirichlet law of weight A is that of a value over A + 1.
    assert found.mean_variance[:, 1] == pytest.approx(within / (counts.sum(axis=1) + 1))


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


def test_a_task_teaches_a_library_of_counts():
    values = [0.0, 1.0, 5.0]
    samples = np.random.default_rng(0).choice(values, size=(2, 2, 8))
    library, by_hand = (PolicyLibrary.from_samples(samples, model="categorical", values=values) for _ in range(2))
    agent = BayesianPolicyReuse(library, prior=[0.0, 1.0], dynamics=STATIC)
    for policy, outcome in ((0, 5.0), (1, 0.0), (0, 5.0)):
        agent.update(policy, outcome)
        by_hand.observe(1, policy, outcome)
    with pytest.raises(InputError, match="least must lie in"):
        agent.teach(0.5)
    assert agent.teach(1.0) == "type 1"
    assert library.performance.counts.tolist() == by_hand.performance.counts.tolist()


def test_a_task_forgets_where_the_type_has_changed():
    """After a change, what was shown before counts less the surer the change is."""
    library = learnt(3, 2, seed=2)
    kept = {}
    for rate in (0.0, 0.01):
        dynamics = TypeDynamics.hazard(rate, library.prior) if rate else STATIC
        agent = BayesianPolicyReuse(library, Greedy(), dynamics=dynamics)
        own = library.performance.mean[0, 0]
        for outcome in np.r_[own + np.linspace(-9, 9, 15), np.full(3, library.performance.mean[1, 0])]:
            agent.update(0, float(outcome))
            kept[rate] = agent.algorithm.state(0)["signal.shown"][0, 0]
    assert kept[0.0] == 18
    assert kept[0.01] < 18


def test_spread_between_tasks_of_a_type_is_found():
    """Types that are like one another leave no spread; types that differ everywhere leave a large one."""
    random = np.random.default_rng(0)
    alike = np.repeat(random.normal(scale=50, size=(4, 1, 6)), 5, axis=1).reshape(20, 6)
    samples = alike[..., None] + random.normal(scale=10, size=(20, 6, 10))
    assert PolicyLibrary.from_samples(samples).performance.spread.values.max() < 0.1
    apart = alike + random.normal(scale=10, size=alike.shape)
    samples = apart[..., None] + random.normal(scale=10, size=(20, 6, 10))
    assert 0.5 < PolicyLibrary.from_samples(samples).performance.spread.values.max() < 4


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


@pytest.mark.parametrize("n", [3, 1000])
def test_heights_of_t_distributions(n):
    """A few are computed one by one, many at once, and above 10⁶ degrees of freedom by a series."""
    freedom = np.geomspace(0.5, 1e8, n)
    assert log_t_height(freedom) == pytest.approx(stats.t.logpdf(0.0, freedom), rel=1e-8)
    assert log_t_height(np.array([[5.0, 1e30]])) == pytest.approx(
        np.array([[stats.t.logpdf(0, 5), stats.norm.logpdf(0)]])
    )


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
