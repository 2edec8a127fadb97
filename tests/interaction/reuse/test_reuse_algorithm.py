"""The steps of Algorithm 7: the printed formulas, single rows against many, with and without the compiler."""

import copy

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.belief import log_prior, update
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse import reuse_algorithm
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.reuse_algorithm import BLOCK, LEAST_SCORED, ReuseAlgorithm
from lifelore.interaction.selection import RULES, BeliefSampling, ExpectedImprovement, Greedy, rule_named
from lifelore.interaction.signals.category_signal import CategorySignal
from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal

N_TYPES, N_POLICIES = 7, 5
RANDOM = np.random.default_rng(3)
MEAN = RANDOM.normal(scale=20, size=(N_TYPES, N_POLICIES))
PROBS = RANDOM.dirichlet(np.full(4, 0.5), (N_TYPES, N_POLICIES))
PROBS[0, :, 0] = 0
PROBS /= PROBS.sum(axis=2, keepdims=True)
SIGNALS = {
    "return": None,
    "category": CategorySignal(PROBS),
    "own": LikelihoodSignal(lambda policy, x: -np.abs(MEAN[:, policy] - x), N_TYPES, N_POLICIES),
}
KINDS = [*SIGNALS, "student-t"]


def library(kind: str = "return") -> PolicyLibrary:
    prior = np.arange(1.0, N_TYPES + 1)
    if kind == "student-t":
        samples = MEAN[..., None] + np.random.default_rng(0).normal(scale=9, size=(*MEAN.shape, 6))
        return PolicyLibrary.from_samples(samples, model=kind, prior=prior / prior.sum())
    return PolicyLibrary.from_means(MEAN, 9.0, signal=SIGNALS[kind], prior=prior / prior.sum())


def drawn(kind: str, random: np.random.Generator, n: int) -> np.ndarray:
    return random.integers(4, size=n) if kind == "category" else random.normal(scale=25, size=n)


def same_bits(one, other) -> bool:
    return np.asarray(one, np.float64).tobytes() == np.asarray(other, np.float64).tobytes()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("hazard", [0.0, 0.1])
def test_an_episode_is_that_of_the_printed_algorithm(kind, hazard):
    model, random = library(kind), np.random.default_rng(1)
    dynamics = TypeDynamics.hazard(hazard, model.prior) if hazard else TypeDynamics.static()
    algorithm = ReuseAlgorithm(model, dynamics)
    log_belief, belief = algorithm.start(), model.prior
    for signal in drawn(kind, random, 6).tolist():
        policy = int(random.integers(N_POLICIES))
        log_likelihood, log_evidence = algorithm.update_row(log_belief, policy, signal)
        joint = np.exp(model.signal.log_likelihood(policy, signal)) * belief
        belief = (1 - hazard) * joint / joint.sum() + hazard * model.prior
        assert log_likelihood.tolist() == model.signal.log_likelihood(policy, signal).tolist()
        assert log_evidence == pytest.approx(np.log(joint.sum()), rel=1e-12)
        assert algorithm.belief(log_belief) == pytest.approx(belief, rel=1e-9, abs=1e-300)
        for rule in (Greedy(), ExpectedImprovement()):
            chosen, scores = algorithm.select(algorithm.belief(log_belief), rule, random)
            assert chosen == scores.argmax()
            assert scores == pytest.approx(rule.scores(model, belief), rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("hazard", [0.0, 0.1])
def test_many_rows_have_the_bits_of_single_rows_and_of_the_plain_rule(kind, hazard, monkeypatch):
    model, random, n = library(kind), np.random.default_rng(2), BLOCK + 3
    dynamics = TypeDynamics.hazard(hazard, model.prior) if hazard else TypeDynamics.static()
    rows, single, plain = (ReuseAlgorithm(model, dynamics) for _ in range(3))
    together = np.tile(rows.start(), (n, 1))
    one_by_one, without, naive = together.copy(), together.copy(), together.copy()
    for _ in range(3):
        policies, signals = random.integers(0, N_POLICIES, n), drawn(kind, random, n)
        evidence, _ = rows.update(together, np.arange(n), policies, signals)
        of_single = [
            single.update_row(*row) for row in zip(one_by_one, policies.tolist(), signals.tolist(), strict=True)
        ]
        with monkeypatch.context() as patched:
            patched.setattr(reuse_algorithm, "kernel_pays", lambda numbers: False)
            plain._compiled = False
            of_plain = [
                plain.update_row(*row) for row in zip(without, policies.tolist(), signals.tolist(), strict=True)
            ]
        for k in range(n):
            after = update(naive[k], model.signal.log_likelihood(int(policies[k]), signals[k].item()))
            naive[k] = dynamics.step(after.log_belief)
        assert same_bits(evidence, [log_evidence for _, log_evidence in of_single])
        assert same_bits(evidence, [log_evidence for _, log_evidence in of_plain])
        assert same_bits(together, one_by_one)
        assert same_bits(together, without)
        # The step of a hazard alone, from logarithms to logarithms, rounds otherwise than both steps in one pass.
        assert together == pytest.approx(naive, rel=1e-12, abs=1e-15 if hazard else 0)
        assert hazard or same_bits(together, naive)


@pytest.mark.parametrize("name", RULES)
def test_an_agent_is_a_row(name):
    model, random = library(), np.random.default_rng(5)
    agent = BayesianPolicyReuse(model, rule_named(name), horizon=9, seed=np.random.default_rng(7))
    algorithm, generator = ReuseAlgorithm(model), np.random.default_rng(7)
    log_belief = algorithm.start()
    for episode in range(9):
        left = 8 - episode
        chosen, _ = algorithm.select(algorithm.belief(log_belief), rule_named(name), generator, left)
        assert agent.select() == chosen
        signal = float(random.normal(MEAN[3, chosen], 9))
        agent.update(chosen, signal)
        algorithm.update_row(log_belief, chosen, signal)
        assert same_bits(agent.log_belief, log_belief)


def test_small_beliefs_are_scored_as_nothing_and_stay():
    model = PolicyLibrary.from_means(np.eye(3), 1.0)
    logs = np.array([[np.log1p(-1e-3), np.log(1e-3), -600.0], [0.0, -np.inf, -575.0]])
    scored, whole = ReuseAlgorithm(model, least=LEAST_SCORED), ReuseAlgorithm(model)
    assert scored.belief(logs)[0].tolist() == [*np.exp(logs[0, :2]), 0.0]
    assert same_bits(scored.belief(logs)[1], np.exp(logs[1]))  # e^-575 is above 1e-250.
    assert same_bits(whole.belief(logs), np.exp(logs))
    assert same_bits(whole.belief(logs, np.array([1, 1])), np.exp(logs[[1, 1]]))
    assert logs[0, 2] == -600.0


@pytest.mark.slow
@pytest.mark.parametrize("rule", [BeliefSampling(), Greedy()])
def test_fast_selection_has_the_probabilities_of_the_rule(rule):
    model, random = library(), np.random.default_rng(0)
    algorithm = ReuseAlgorithm(model)
    belief = np.tile(model.prior, (20_000, 1))
    stated = rule.probabilities(model, model.prior)
    for chosen in (algorithm.select_fast(belief, rule, random), algorithm.select(belief, rule, random)[0]):
        # A share of 20000 has a deviation of at most 0.0035; five of them.
        assert np.bincount(chosen, minlength=N_POLICIES) / 20_000 == pytest.approx(stated, abs=0.018)


def test_an_episode_without_a_signal_is_a_step_of_the_dynamics():
    model = library()
    changing = TypeDynamics.hazard(0.2, model.prior)
    agent = BayesianPolicyReuse(model, prior=np.eye(N_TYPES)[2], dynamics=changing)
    agent.skip()
    assert agent.belief == pytest.approx(0.2 * model.prior + 0.8 * np.eye(N_TYPES)[2])
    assert (agent.episode, agent.surprise) == (1, 0.0)
    static = BayesianPolicyReuse(model, dynamics=TypeDynamics.static())
    static.skip()
    assert same_bits(static.log_belief, log_prior(model.prior))


def test_many_single_updates_start_the_compiler(monkeypatch):
    counted: list[int] = []
    monkeypatch.setattr(
        reuse_algorithm, "kernel_pays", lambda numbers: counted.append(numbers) or len(counted) == 3
    )
    algorithm = ReuseAlgorithm(library())
    log_belief = algorithm.start()
    for _ in range(5):
        algorithm.update_row(log_belief, 0, 3.0)
    # Asked until it pays, about all the work so far; never again afterwards.
    assert len(counted) == 3
    assert counted == [counted[0], 2 * counted[0], 3 * counted[0]]


def test_the_algorithm_can_be_copied_while_it_runs():
    agent = BayesianPolicyReuse(library())
    agent.update(0, 3.0)
    agent.select()
    twin = copy.deepcopy(agent)
    for one in (agent, twin):
        one.update(1, -4.0)
    assert same_bits(agent.log_belief, twin.log_belief)


def test_dynamics_and_priors_of_another_size_are_refused():
    with pytest.raises(InputError, match="dynamics are for 3 types"):
        ReuseAlgorithm(library(), TypeDynamics.hazard(0.1, [0.2, 0.3, 0.5]))
    with pytest.raises(InputError, match=r"prior must be \(7,\)"):
        ReuseAlgorithm(library()).start([0.5, 0.5])
