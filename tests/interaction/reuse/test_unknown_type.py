"""The probability that no known type fits: by hand, beside the detector, and as state."""

from math import log

import numpy as np
import pytest
from scipy.stats import norm, t

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.broad_law import FREEDOM
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.novelty.novelty_detector import NoveltyCalibration, NoveltyDetector
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.unknown_type import UnknownType
from lifelore.interaction.selection import BeliefSampling
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal

TRUE = np.array([[200.0, 80, 120], [60, 210, 110], [90, 100, 220]])


def learnt(n: int = 10, **options) -> PolicyLibrary:
    return PolicyLibrary.from_samples(np.random.default_rng(0).normal(TRUE[..., None], 20, (3, 3, n)), **options)


def test_one_signal_by_hand():
    library = PolicyLibrary.from_means([[10.0], [0.0]], 2.0)
    agent = BayesianPolicyReuse(library, novelty=0.2)
    assert agent.novelty is not None
    assert agent.novelty.probability == pytest.approx(0.2, abs=1e-15)
    agent.update(0, 6.0)
    # Pooled mean 5, variance 4, spread over types 25: the mean counts as 4 / 25 outcomes.
    broad = t.logpdf(6.0, FREEDOM, 5.0, np.sqrt(4 * (1 + 25 / 4)))
    known = np.log(0.5 * norm.pdf(6, 10, 2) + 0.5 * norm.pdf(6, 0, 2))
    assert agent.novelty.log_odds == pytest.approx(broad - known, abs=1e-12)
    odds = np.exp(broad - known) * 0.2 / 0.8
    assert agent.novelty.probability == pytest.approx(odds / (1 + odds), rel=1e-12)


@pytest.mark.parametrize("kind", ["outcomes", "categories"])
def test_with_plug_in_models_the_odds_are_those_of_the_detector(kind):
    random = np.random.default_rng(1)
    signal = None if kind == "outcomes" else CategorySignal(random.dirichlet(np.ones(4), (3, 3)))
    library = learnt(signal=signal)
    agent = BayesianPolicyReuse(
        library, BeliefSampling(), models="plug-in", dynamics=TypeDynamics.static(), novelty=0.05
    )
    detector = NoveltyDetector(library, NoveltyCalibration(0.01, np.zeros(9), np.ones(9), 5.0, 1000))
    for _ in range(9):
        policy = agent.select()
        detector.update(agent, policy, random.normal(140, 30) if signal is None else int(random.integers(4)))
        assert agent.novelty is not None
        assert agent.novelty.probability == pytest.approx(detector.probability, rel=1e-9)


@pytest.mark.parametrize("models", ["uncertain", "plug-in"])
def test_the_belief_is_the_same_with_and_without(models):
    with_it, without = (
        BayesianPolicyReuse(learnt(), seed=3, models=models, novelty=mass) for mass in (0.05, None)
    )
    random = np.random.default_rng(2)
    for _ in range(12):
        policy = with_it.select()
        assert without.select() == policy
        outcome = float(random.normal(TRUE[1, policy], 20))
        with_it.update(policy, outcome)
        without.update(policy, outcome)
    assert with_it.log_belief.tobytes() == without.log_belief.tobytes()
    assert without.novelty is None
    assert without.explain().novelty is None
    assert with_it.novelty is not None
    assert with_it.explain().novelty == with_it.novelty.probability


def test_new_users_are_told_from_known_users():
    random, library = np.random.default_rng(5), learnt()
    found = {}
    for name, means in (("known", TRUE[2]), ("new", np.array([150.0, 90, 160]))):
        probabilities = []
        for task in range(20):
            agent = BayesianPolicyReuse(library, BeliefSampling(), seed=task, novelty=0.05)
            for _ in range(15):
                policy = agent.select()
                agent.update(policy, float(random.normal(means[policy], 20)))
            assert agent.novelty is not None
            probabilities.append(agent.novelty.probability)
        found[name] = float(np.median(probabilities))
    # Outcomes deviate by 20; the new user's best outcome is 50 or 60 from those of every type.
    assert found["known"] < 0.02
    assert found["new"] > 0.99


def test_ten_runs_leave_a_type_in_doubt_as_far_as_the_runs_do():
    samples = np.array([[[9.0, 11.0, 10.0, 8.0, 12.0, 10.0]]])
    library = PolicyLibrary.from_samples(samples)
    unknown = UnknownType(library, dynamics=TypeDynamics.static())
    unknown.add(0, 13.0)
    unknown.add(0, 12.0)
    # The predictive of the runs and the task together: both count alike, because a task is just like its type.
    moments = library.performance.moments  # pyright: ignore[reportAttributeAccessIssue]
    mean, variance, n, freedom = 10.0, float(moments.variance[0, 0]), 6, float(moments.freedom[0, 0])
    expected, k, x, s = 0.0, 0, 0.0, 0.0
    broad = UnknownType(library)._broad
    for outcome in (13.0, 12.0):
        shown = np.array([[k, x, s]])
        expected += float(broad.log_density(shown, np.array([0]), np.array([outcome]))[0])
        scale2 = (freedom * variance + s + n * k / (n + k) * (x - mean) ** 2) / (freedom + k) * (1 + 1 / (n + k))
        place = (n * mean + k * x) / (n + k)
        expected -= t.logpdf(outcome, freedom + k, place, np.sqrt(scale2))
        s, k, x = s + (outcome - x) ** 2 * k / (k + 1), k + 1, (k * x + outcome) / (k + 1)
    assert unknown.log_odds == pytest.approx(expected, rel=1e-9)


def test_the_order_of_signals_does_not_matter_where_types_are_static():
    signals = [(0, 150.0), (1, 90.0), (0, 140.0), (2, 160.0)]
    found = []
    for order in (signals, signals[::-1]):
        agent = BayesianPolicyReuse(learnt(), dynamics=TypeDynamics.static(), models="plug-in", novelty=0.05)
        for policy, outcome in order:
            agent.update(policy, outcome)
        assert agent.novelty is not None
        found.append(agent.novelty.log_odds)
    assert found[0] == pytest.approx(found[1], rel=1e-12)


def test_an_impossible_signal_counts_745_nats_and_stays_finite():
    library = PolicyLibrary.from_means([[1.0]], 1.0, signal=CategorySignal([[[1.0, 0.0]]]))
    agent = BayesianPolicyReuse(library, novelty=0.5)
    for _ in range(3):
        agent.update(0, 1)
    assert agent.novelty is not None
    assert agent.novelty.probability == 1.0
    assert agent.novelty.log_odds == pytest.approx(3 * 745 + log(0.005 * 0.505 * 0.67), abs=10)


def test_a_restored_state_has_the_same_bits():
    unknown = UnknownType(learnt(), 0.1)
    unknown.add(2, 130.0)
    unknown.add(0, 90.0)
    again = UnknownType.restored(
        unknown.state(), learnt(), TypeDynamics.hazard(0.002, np.full(3, 1 / 3)), "uncertain"
    )
    for found in (unknown, again):
        found.add(2, 180.0)
    assert again.log_odds == unknown.log_odds
    assert again.mass == 0.1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"policies": np.array([7])}, "policies 0 to 2"),
        ({"log_belief": np.zeros(9)}, "no evidence of an unknown type"),
        ({"task.signal.shown": np.zeros((2, 3))}, "a task's state must have"),
        ({"shown": np.zeros((1, 2))}, "of another library"),
        ({"shown": np.full((1, 3), np.nan)}, "of another library"),
        ({"numbers": np.array([2.0, 0.0])}, "between 0 and 1"),
        ({"numbers": np.array([0.5])}, "no evidence of an unknown type"),
    ],
)
def test_states_that_are_none_are_refused(change, message):
    unknown = UnknownType(learnt())
    unknown.add(1, 100.0)
    with pytest.raises(InputError, match=message):
        UnknownType.restored(unknown.state() | change, learnt(), TypeDynamics.static(), "uncertain")


def test_mistakes_are_said():
    for mass in (0.0, 1.0, float("nan")):
        with pytest.raises(InputError, match="novelty must lie between 0 and 1"):
            BayesianPolicyReuse(learnt(), novelty=mass)
    own = LikelihoodSignal(lambda policy, x: [0.0, -1.0, -2.0], 3)
    with pytest.raises(InputError, match="outcomes or categories"):
        BayesianPolicyReuse(learnt(signal=own), BeliefSampling(), novelty=0.05)
