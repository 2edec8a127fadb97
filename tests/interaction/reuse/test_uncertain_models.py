"""The belief over types and the parameters of their models, beside direct computations."""

from typing import Any

import numpy as np
import pytest
from scipy import integrate, stats

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.library.task_library import TaskLibrary
from lifelore.interaction.outcomes import task_normals, task_outcomes
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.outcome_moments import OutcomeMoments
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.reuse import reuse_algorithm
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.reuse_session import load_session, save_session, session_bytes
from lifelore.interaction.selection import RULES, ExpectedImprovement, Greedy, InformationDirected, rule_named
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.transition_signal import TransitionSignal

STATIC = TypeDynamics.static()


def learnt(n_types=4, n_policies=3, n=6, spread=0.0, seed=0, **options) -> PolicyLibrary:
    random = np.random.default_rng(seed)
    mean = random.normal(scale=30, size=(n_types, n_policies))
    library = PolicyLibrary.from_samples(
        mean[..., None] + random.normal(scale=10, size=(*mean.shape, n)), **options
    )
    if spread is not None:
        outcomes_of(library).moments.spread = Spread.known(spread)
    return library


def outcomes_of(library: PolicyLibrary | TaskLibrary | None) -> Any:
    """The performance model, whose class is not the protocol's."""
    assert library is not None
    return library.performance


def evidence_by_integration(moments: OutcomeMoments, spread: float, type_: int, policy: int, values) -> float:
    """p(values | type) by integrating over mean and variance; nothing is taken from the code under test."""
    m0, v0, n = (field[type_, policy] for field in (moments.mean, moments.variance, moments.count))
    freedom, weight = moments.freedom[type_, policy], 1 / (1 / n + spread)

    def given_variance(variance: float) -> float:
        prior = stats.invgamma.pdf(variance, freedom / 2, scale=freedom * v0 / 2)
        # Given the variance, outcomes and mean are jointly normal.
        k = len(values)
        covariance = variance * (np.eye(k) + np.full((k, k), 1 / weight))
        return prior * stats.multivariate_normal.pdf(values, np.full(k, m0), covariance)

    return integrate.quad(given_variance, 0, np.inf, limit=400, epsabs=0, epsrel=1e-9)[0]


@pytest.mark.parametrize("spread", [0.0, 0.7])
def test_the_belief_is_that_of_integrating_all_parameters_out(spread):
    library, values = learnt(spread=spread), {0: [12.0, 20.0, 15.0], 2: [-5.0]}
    agent = BayesianPolicyReuse(library, Greedy(), dynamics=STATIC)
    for policy, outcomes in values.items():
        for outcome in outcomes:
            agent.update(policy, outcome)
    evidence = np.ones(library.n_types)
    for policy, outcomes in values.items():
        for type_ in range(library.n_types):
            moments = outcomes_of(library).moments
            evidence[type_] *= evidence_by_integration(moments, spread, type_, policy, outcomes)
    assert agent.belief == pytest.approx(evidence / evidence.sum(), rel=1e-6)


def test_means_are_those_of_the_conjugate_law():
    library = learnt(spread=0.5)
    moments, shown = outcomes_of(library).moments, np.array([3.0, 9.0, 4.0])
    agent = BayesianPolicyReuse(library, Greedy(), dynamics=STATIC)
    for outcome in shown:
        agent.update(1, outcome)
    weight = 1 / (1 / moments.count[:, 1] + 0.5)
    mean = (weight * moments.mean[:, 1] + shown.sum()) / (weight + 3)
    assert outcomes_of(agent.task).mean[:, 1] == pytest.approx(mean)
    untried = [0, 2]
    assert np.array_equal(outcomes_of(agent.task).mean[:, untried], moments.mean[:, untried])
    assert agent.expected_utility() == pytest.approx(agent.belief @ outcomes_of(agent.task).mean)


def test_exact_models_have_nothing_to_learn():
    library = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 2.0)
    assert library.for_task() is None
    both = [BayesianPolicyReuse(library, models=models, seed=3) for models in ("uncertain", "plug-in")]
    for agent in both:
        for outcome in (9.0, 3.0, 5.0):
            agent.update(agent.select(), outcome)
    assert np.array_equal(both[0].log_belief, both[1].log_belief)


def test_many_runs_approach_the_plug_in_model():
    library = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 2.0, count=1e9)
    outcomes_of(library).moments.spread = Spread.known(0.0)
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


@pytest.mark.parametrize("model", ["gaussian", "student-t", "histogram", "categorical"])
def test_every_rule_selects_with_every_kind_of_model(model):
    random = np.random.default_rng(1)
    samples = random.integers(0, 3, (5, 4, 6)).astype(float)
    options = {"edges": [-0.5, 0.5, 1.5, 2.5]} if model == "histogram" else {}
    library = PolicyLibrary.from_samples(samples, model=model, **options)
    for name in RULES:
        agent = BayesianPolicyReuse(library, rule_named(name), seed=1)
        for _ in range(4):
            agent.update(agent.select(), float(random.integers(0, 3)))
        assert agent.probabilities().sum() == pytest.approx(1)
        assert np.isfinite(outcomes_of(agent.task).expected_mean_excess(1.0)).all()


def test_dirichlet_counts_are_those_of_polya_urns():
    values = [0.0, 1.0, 5.0]
    samples = np.random.default_rng(0).choice(values, size=(3, 2, 8))
    library = PolicyLibrary.from_samples(samples, model="categorical", values=values)
    outcomes_of(library)._spread = Spread.known(0.0)
    agent, shown = BayesianPolicyReuse(library, Greedy(), dynamics=STATIC), [0, 2, 2, 1]
    evidence = np.ones(3)
    counts = outcomes_of(library).counts[1].copy()
    for cell in shown:
        agent.update(1, values[cell])
        evidence *= counts[:, cell] / counts.sum(axis=1)
        counts[:, cell] += 1
    assert agent.belief == pytest.approx(evidence / evidence.sum(), rel=1e-10)
    assert outcomes_of(agent.task).mean[:, 1] == pytest.approx(counts @ values / counts.sum(axis=1))


def test_a_signal_apart_from_the_outcome_teaches_both_models():
    paths = np.random.default_rng(0).integers(0, 4, (3, 2, 8))
    library = PolicyLibrary(
        learnt(3, 2).performance, CategorySignal.from_samples(paths, 4, categories=["a", "b", "c", "d"])
    )
    agent = BayesianPolicyReuse(library, Greedy(), dynamics=STATIC)
    agent.update(0, "a", outcome=40.0)
    assert (outcomes_of(agent.task).mean[:, 0] != library.performance.mean[:, 0]).all()
    before = outcomes_of(agent.task).mean.copy()
    agent.update(1, "b")
    assert np.array_equal(outcomes_of(agent.task).mean, before), "no outcome, nothing learnt about outcomes"
    with pytest.raises(InputError, match="signal must be one of"):
        agent.update(1, "e")


def test_steps_of_an_episode_are_a_polya_urn():
    counts = np.array([[[[3.0, 1.0]], [[1.0, 1.0]]], [[[1.0, 3.0]], [[2.0, 2.0]]]])
    signal = TransitionSignal.from_counts(counts, 0.5)
    library = PolicyLibrary(learnt(2, 2).performance, signal)
    agent = BayesianPolicyReuse(library, Greedy(), dynamics=STATIC)
    agent.update(0, [(0, 0), (0, 0)])
    agent.update(1, [(0, 1)])
    weights, evidence = counts + 0.5, np.ones(2)
    for state, after in ((0, 0), (0, 0), (0, 1)):
        row = weights[:, state, 0]
        evidence *= row[:, after] / row.sum(axis=1)
        row[:, after] += 1
    assert agent.belief == pytest.approx(evidence / evidence.sum(), rel=1e-10)


@pytest.mark.parametrize("spread", [None, 0.3])
@pytest.mark.parametrize("rule", ["expected-improvement", "information-directed", "sampling"])
def test_a_session_goes_on_bit_for_bit(tmp_path, rule, spread):
    library = learnt(spread=spread)
    agent = BayesianPolicyReuse(
        library, rule_named(rule), seed=5, dynamics=TypeDynamics.hazard(0.01, library.prior)
    )
    random = np.random.default_rng(0)
    for _ in range(5):
        agent.update(agent.select(), random.normal(0, 30))
    save_session(agent, tmp_path / "session.npz")
    again = load_session(tmp_path / "session.npz")
    for outcome in random.normal(0, 30, 6):
        assert again.select() == agent.select()
        for one in (agent, again):
            one.update(1, outcome)
        assert np.array_equal(again.log_belief, agent.log_belief)
    assert session_bytes(agent) == session_bytes(again)


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
        assert getattr(outcomes_of(library).moments, field) == pytest.approx(
            getattr(outcomes_of(by_hand).moments, field)
        )
    with pytest.raises(InputError, match="taught the library before"):
        agent.teach()
    assert BayesianPolicyReuse(learnt(2, 2)).teach() is None, "the type is not known"


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
            kept[rate] = outcomes_of(agent.task).shown[0][0]
    assert kept[0.0] == 18
    assert kept[0.01] < 18


def test_spread_between_tasks_of_a_type_is_found():
    """Types that are like one another leave no spread; types that differ everywhere leave a large one."""
    random = np.random.default_rng(0)
    alike = np.repeat(random.normal(scale=50, size=(4, 1, 6)), 5, axis=1).reshape(20, 6)
    samples = alike[..., None] + random.normal(scale=10, size=(20, 6, 10))
    assert outcomes_of(PolicyLibrary.from_samples(samples)).spread.values.max() < 0.1
    apart = alike + random.normal(scale=10, size=alike.shape)
    samples = apart[..., None] + random.normal(scale=10, size=(20, 6, 10))
    assert 0.5 < outcomes_of(PolicyLibrary.from_samples(samples)).spread.values.max() < 4


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


@pytest.mark.parametrize("shape", [(4, 3, 6), (4, 1, 6), (1, 3, 6)])
@pytest.mark.parametrize("model", ["gaussian", "student-t", "histogram", "categorical"])
def test_an_agent_at_work_does_not_see_what_its_library_learns_later(model, shape):
    samples = np.random.default_rng(0).integers(0, 3, shape).astype(float)
    options: dict[str, Any] = {"edges": np.linspace(-0.5, 2.5, 4)} if model == "histogram" else {}
    states = []
    for runs_later in (0, 30):
        library = PolicyLibrary.from_samples(samples, model=model, **options)
        agent = BayesianPolicyReuse(library, Greedy())
        for _ in range(runs_later):
            library.observe(0, 0, 2.0)
        for policy, value in ((0, 2.0), (0, 1.0), (shape[1] - 1, 2.0)):
            agent.update(policy, value)
        assert agent.task is not None
        states.append([agent.log_belief, agent.expected_utility(), agent.task.performance.deviation])
    assert all(np.array_equal(a, b) for a, b in zip(*states, strict=True))


def test_models_has_two_names():
    with pytest.raises(InputError, match="'uncertain' or 'plug-in'"):
        BayesianPolicyReuse(learnt(), models="exact")  # type: ignore[arg-type]
    assert BayesianPolicyReuse(learnt(), InformationDirected(), models="plug-in").task is None


@pytest.mark.parametrize("static", [False, True])
def test_kernels_and_numpy_give_the_same_bits(monkeypatch, static):
    """With several spreads, runs that differ in number, exact pairs and an outcome far from all types."""
    random = np.random.default_rng(4)
    counts = np.where(random.random((7, 5)) < 0.2, np.inf, random.integers(1, 20, (7, 5)))
    library = PolicyLibrary.from_means(random.normal(scale=30, size=(7, 5)), 10.0, count=counts)
    outcomes_of(library).moments.spread = Spread.up_to(0.8)
    signals = [(int(random.integers(5)), float(value)) for value in [*random.normal(scale=30, size=40), 1e6]]
    found = {}
    for compiled in (False, True):
        for module in (task_normals, task_outcomes, reuse_algorithm):
            monkeypatch.setattr(module, "kernel_pays", lambda numbers, pays=compiled: pays)
        agent = BayesianPolicyReuse(library, Greedy(), dynamics=TypeDynamics.static() if static else None)
        states = []
        for policy, value in signals[:20] + signals[-1:] + signals[20:]:
            agent.update(policy, value)
            model = outcomes_of(agent.task)
            excess = model.expected_mean_excess(float(model.mean.max()) - 5.0)
            next_density = model.log_density(policy, value + 1.0)
            states += [
                agent.log_belief,
                model.mean.copy(),
                model.noise.copy(),
                model.mean_variance,
                excess,
                next_density,
            ]
        found[compiled] = states
    assert all(np.array_equal(a, b) for a, b in zip(found[True], found[False], strict=True))


@pytest.mark.parametrize("static", [False, True])
def test_kernels_and_numpy_give_the_same_bits_of_categories(monkeypatch, static):
    """With several spreads, categories that some or all types never showed, and outcomes beside the signal."""
    random = np.random.default_rng(5)
    probs = random.dirichlet(np.full(5, 0.4), size=(6, 4))
    probs[random.random(probs.shape) < 0.3] = 0.0
    probs[:, 2, 3] = 0.0
    probs /= probs.sum(axis=2, keepdims=True)
    signal = CategorySignal(probs, count=random.integers(1, 20, (6, 4)))
    signal._spread = Spread.up_to(0.8)
    paid = CategoricalOutcomes.from_samples(random.integers(0, 3, (6, 4, 8)).astype(float), [0.0, 1.0, 2.0])
    paid.spread = Spread.up_to(0.5)
    library = PolicyLibrary(paid, signal)
    shown = [(*random.integers((4, 5)).tolist(), float(random.integers(3))) for _ in range(40)]
    found = {}
    for compiled in (False, True):
        for module in (task_outcomes, reuse_algorithm):
            monkeypatch.setattr(module, "kernel_pays", lambda numbers, pays=compiled: pays)
        agent = BayesianPolicyReuse(library, Greedy(), dynamics=TypeDynamics.static() if static else None)
        states = []
        for policy, category, outcome in [*shown[:20], (2, 3, 1.0), *shown[20:]]:
            agent.update(policy, category, outcome)
            assert agent.task is not None
            states += [agent.log_belief, agent.task.evidence.log_weights, agent.expected_utility()]
        found[compiled] = [*states, [agent.surprise, agent.unexplained]]
    assert found[True][-1][1] >= 1  # the category that no type ever showed
    assert all(np.array_equal(a, b) for a, b in zip(found[True], found[False], strict=True))


def test_the_excess_of_means_is_that_of_normals():
    agent = BayesianPolicyReuse(learnt(), ExpectedImprovement(), dynamics=TypeDynamics.static())
    for policy, value in ((0, 3.0), (1, -2.0), (0, 4.0)):
        agent.update(policy, value)
    model = outcomes_of(agent.task)
    deviation = np.sqrt(model.mean_variance)
    for threshold in (-100.0, 0.0, 3.0, 100.0):
        z = (model.mean - threshold) / deviation
        exact = deviation * stats.norm.pdf(z) + (model.mean - threshold) * stats.norm.cdf(z)
        assert model.expected_mean_excess(threshold) == pytest.approx(exact, rel=1e-9, abs=1e-20)
