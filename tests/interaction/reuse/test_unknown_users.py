"""Users whom no type fits: the odds of the unknown type, and the policies that are tried on them."""

import numpy as np
import pytest
from scipy.stats import t

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.interaction.reuse.unknown_users import DEVIATIONS, GAIN, MASS
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.interaction.selection import InformationDirected
from lifelore.interaction.signals.return_signal import ReturnSignal

MEANS = np.array([[1.0, 0.0, 0.7], [0.0, 1.0, 0.7]])
STRANGER = [0.5, 0.5, 2.0]
RULE = InformationDirected()
TRIED = (0, 1, 2) * 6
FREEDOM = 14  # ten runs less one, and five that the pooled variance counts as


@pytest.fixture
def library():
    """Two types from ten runs a pair; both like the third policy somewhat less than the best."""
    random = np.random.default_rng(0)
    return PolicyLibrary.from_samples(random.normal(MEANS[..., None], 0.5, (2, 3, 10)))


def lived(agent, means, episodes=60):
    """The policies of a user with these mean pays."""
    random, chosen = np.random.default_rng(1), []
    for _ in range(episodes):
        chosen.append(agent.select())
        agent.update(chosen[-1], random.normal(means[chosen[-1]], 0.5))
    return chosen


def stranger(library):
    """An agent that takes its user for one whom no type fits."""
    agent = BayesianPolicyReuse(library)
    for policy in TRIED:
        agent.update(policy, STRANGER[policy])
    agent.algorithm.unknown.log_odds[0] = 1.0
    return agent


class Twin:
    """The unknown type from the list of outcomes of each policy, anew at each question."""

    def __init__(self, library):
        moments = library.performance.moments
        self.centre, self.variance = moments.mean.mean(axis=0), moments.variance.mean(axis=0)
        spread = ((moments.mean - self.centre) ** 2).mean(axis=0)
        self.weight = self.variance / np.maximum(spread, spread.mean())
        self.seen = [[] for _ in self.centre]

    def law(self, policy):
        """Location, weight, variance and freedom of the normal-inverse-χ² law of a policy's pays."""
        seen, weight, centre = self.seen[policy], self.weight[policy], self.centre[policy]
        total, freedom = weight + len(seen), FREEDOM + len(seen)
        location = (weight * centre + sum(seen)) / total
        # Every outcome, and the prior's weight at its centre, around the location.
        squares = sum((x - location) ** 2 for x in seen) + weight * (centre - location) ** 2
        return location, total, (FREEDOM * self.variance[policy] + squares) / freedom, freedom

    def log_density(self, policy, value):
        location, weight, variance, freedom = self.law(policy)
        return t.logpdf(value, freedom, location, np.sqrt(variance * (1 + 1 / weight)))

    def bound(self, policy):
        location, weight, variance, freedom = self.law(policy)
        return location + DEVIATIONS * np.sqrt(variance * freedom / (freedom - 2) / weight)

    def gain(self, odds, known, available):
        """Possible gain of trying policies over `known`, in deviations of a mean pay of which nothing is shown."""
        unit = np.sqrt(np.mean(self.variance * FREEDOM / (FREEDOM - 2) / self.weight))
        return (max(self.bound(policy) for policy in available) - known) / (1 + np.exp(-odds)) / unit


@pytest.mark.parametrize("dtype", ["f8", "f4"])
def test_odds_and_bounds_are_those_of_the_twin(library, dtype):
    random, twin = np.random.default_rng(3), Twin(library)
    rows, odds = ReuseAlgorithm(library, dtype=dtype), np.log(MASS / (1 - MASS))
    digits = 1e-9 if dtype == "f8" else 1e-4
    for _ in range(30):  # types may change between episodes; what was shown of the unknown type stays
        policy, value = int(random.integers(3)), float(random.normal(1, 2))
        odds += twin.log_density(policy, value) - float(rows.update(0, policy, value).log_evidence)
        twin.seen[policy].append(value)
        assert rows.unknown.log_odds[0] == pytest.approx(odds, abs=digits * 30)
        bounds = [twin.bound(each) for each in range(3)]
        assert rows.unknown.bounds(0) == pytest.approx(bounds, abs=digits)


@pytest.mark.parametrize("available", [(0, 1, 2), (1, 2)])
def test_policies_are_tried_where_the_possible_gain_is_large_enough(library, available):
    mask, user, found = np.isin(range(3), available), 0, set()
    for odds in np.linspace(-4, 1, 11):
        rows, twin = ReuseAlgorithm(library, 1), Twin(library)
        for policy, value in ((0, 0.2), (1, 0.3), (0, 0.4)):
            rows.update(user, policy, value)
            twin.seen[policy].append(value)
        rows.unknown.log_odds[user] = odds
        best = rows.known(user).performance.mean[:, mask].max(axis=1) @ rows.belief(user)
        tried = bool(odds > 0 or twin.gain(odds, best, available) > GAIN)
        expected = [twin.bound(policy) for policy in available]
        assert (rows.scores(user, RULE, available=mask)[mask] == pytest.approx(expected)) == tried
        found.add((bool(odds > 0), tried))
    assert found == {(False, False), (False, True), (True, True)}


def test_a_user_whom_no_type_fits_is_found_out(library):
    assert 2 not in lived(BayesianPolicyReuse(library, models="plug-in"), STRANGER)
    assert lived(BayesianPolicyReuse(library), STRANGER)[-20:] == [2] * 20


def test_a_known_user_is_served_as_by_the_known_types_alone(library):
    agent = BayesianPolicyReuse(library)
    alone = BayesianPolicyReuse(library)
    alone.algorithm = ReuseAlgorithm(library, unknown=None)
    assert lived(agent, MEANS[0]) == lived(alone, MEANS[0])
    assert agent.algorithm.unknown.log_odds[0] < np.log(MASS / (1 - MASS))


def test_a_known_user_whose_policies_differ_in_noise_is_known():
    """Few runs overestimate the small noise of the first policy; the unknown type must not gain by that."""
    noise, random = np.array([0.1, 1.0, 3.0]), np.random.default_rng(5)
    library = PolicyLibrary.from_samples(random.normal(MEANS[..., None], noise[:, None], (2, 3, 10)))
    rows, every = ReuseAlgorithm(library, 40), np.arange(40)
    for _ in range(40):
        rows.update(every, np.zeros(40, int), random.normal(MEANS[0, 0], 0.1, 40))
    assert (rows.unknown.log_odds > 0).mean() <= 0.05


def test_policies_are_tried_by_their_bounds_among_those_available(library):
    agent = stranger(library)
    bounds = agent.algorithm.unknown.bounds(0)
    assert [one.score for one in agent.select_top(3)] == pytest.approx(np.sort(bounds)[::-1])
    assert (agent.select(), agent.probabilities().tolist()) == (2, [0, 0, 1])
    best = int(bounds[:2].argmax())
    assert agent.select([0, 1]) == best == agent.probabilities([0, 1]).argmax()
    # Rules that do not try policies choose by the known types.
    assert BayesianPolicyReuse(library, "greedy").rule.name == "greedy"
    greedy = ReuseAlgorithm(library)
    greedy.restore(0, agent.log_belief, agent.algorithm.state(0))
    scores = greedy.scores(0, BayesianPolicyReuse(library, "greedy").rule)
    assert scores == pytest.approx(agent.expected_utility())


def test_strangers_among_known_users_are_served_as_they_would_be_alone(library):
    strange, known, rows = stranger(library), BayesianPolicyReuse(library), ReuseAlgorithm(library, 3)
    every, generator = np.arange(3), np.random.default_rng(0)
    for policy in TRIED:
        known.update(policy, MEANS[1, policy])
        pays = [MEANS[1, policy], STRANGER[policy], MEANS[1, policy]]
        rows.update(every, np.full(3, policy), np.array(pays))
    rows.unknown.log_odds[:] = [-3.0, 1.0, -3.0]
    for available in (None, [True, True, False], [[True, False, True], [True, True, False], [True] * 3]):
        mask = np.array(np.broadcast_to(True if available is None else available, (3, 3)))
        found, (chosen, _) = rows.propensities(every, RULE, mask), rows.select(every, RULE, generator, mask)
        for row, agent in enumerate((known, strange, known)):
            assert found[row] == pytest.approx(agent.probabilities(mask[row]))
            assert found[row, chosen[row]] > 0
    assert (rows.select(every, RULE, generator)[0] == [1, 2, 1]).all()


def test_a_stranger_among_many_is_served_as_alone(library):
    library.performance.spread = Spread.known(0.1)
    users, agents = UserBeliefs(library, 2, "f8"), [BayesianPolicyReuse(library) for _ in range(2)]
    random = np.random.default_rng(2)
    for _ in range(40):
        chosen = users.select([0, 1])
        assert users.probabilities([0, 1]) == pytest.approx(np.array([one.probabilities() for one in agents]))
        pays = random.normal(np.array([MEANS[1], STRANGER])[[0, 1], chosen], 0.5)
        users.update([0, 1], chosen, pays)
        for agent, policy, pay in zip(agents, chosen, pays, strict=True):
            agent.update(policy, pay)
    assert chosen.tolist() == [1, 2]
    assert [one.explain().novelty > 0.5 for one in agents] == [False, True]


def test_a_stored_state_goes_on_and_a_reset_user_is_new(library):
    agent = stranger(library)
    state = agent.algorithm.state(0)
    other = ReuseAlgorithm(library, 2)
    other.restore(1, agent.log_belief, state)
    assert other.unknown.log_odds[1] == agent.algorithm.unknown.log_odds[0]
    assert other.unknown.bounds(np.array([1]))[0] == pytest.approx(agent.algorithm.unknown.bounds(0))
    other.reset(1)
    assert other.unknown.log_odds[1] == other.unknown.log_odds[0] == pytest.approx(np.log(MASS / (1 - MASS)))


def test_none_is_looked_for_where_models_are_exact_or_a_type_is_alone(library):
    assert ReuseAlgorithm(library, models="plug-in").unknown is None
    assert ReuseAlgorithm(PolicyLibrary.from_means(MEANS, 1.0)).unknown is None
    assert ReuseAlgorithm(PolicyLibrary.from_samples(np.random.default_rng(0).random((1, 2, 9)))).unknown is None


def test_none_is_looked_for_where_the_signals_are_not_the_outcomes(library):
    """Bounds of signals are no outcomes: here the third policy has the highest signals and the lowest outcomes."""
    outcomes = PolicyLibrary.from_means([[1.0, 0.0, -9.0], [0.0, 1.0, -9.0]], 1.0).performance
    agent = BayesianPolicyReuse(PolicyLibrary(outcomes, ReturnSignal(library.performance)))
    for policy in TRIED:
        agent.update(policy, STRANGER[policy])
    assert agent.algorithm.unknown is None
    assert agent.select() != 2


def test_an_explanation_says_how_probably_no_type_fits(library):
    assert stranger(library).explain().novelty == pytest.approx(1 / (1 + np.exp(-1)))
    assert BayesianPolicyReuse(library).explain().novelty == pytest.approx(MASS)
    assert BayesianPolicyReuse(library, models="plug-in").explain().novelty is None
    earlier = BayesianPolicyReuse(library)  # restored from before there was an unknown type
    earlier.algorithm.restore(0, earlier.log_belief, ReuseAlgorithm(library, unknown=None).state(0))
    earlier.update(0, 9.0)
    assert earlier.explain().novelty is None
    assert BayesianPolicyReuse(library, novelty=0.05).explain().novelty == pytest.approx(0.05)
