"""Trials of information-directed selection: a policy that may pay a user more than the type says is tried."""

import numpy as np
import pytest

from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.prediction import NormalPrediction
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.user_beliefs import UserBeliefs
from lifelore.interaction.selection.information_directed import AHEAD, InformationDirected, gain_of_trial

TRIALS = InformationDirected(trials=True)
MEAN, VARIANCE = np.array([[1.0, 0.4, -3.0]]), np.array([[0.1, 0.5, 0.5]])


class Outcomes(NormalPrediction):
    """One type with noise of variance 1, and normal mean pays."""

    mean, mean_variance = MEAN, VARIANCE
    deviation = np.sqrt(VARIANCE + 1)


def test_the_gain_of_a_trial_is_that_of_bayes_rule_over_all_outcomes():
    found = gain_of_trial(Outcomes(), np.ones(1), MEAN[0])
    for policy, (mean, variance) in enumerate(zip(MEAN[0], VARIANCE[0], strict=True)):
        seen = np.linspace(-12, 12, 200_001)
        density = np.exp(-0.5 * (seen - mean) ** 2 / (variance + 1)) / np.sqrt(2 * np.pi * (variance + 1))
        after = mean + variance / (variance + 1) * (seen - mean)
        expected = (density * np.maximum(after - 1.0, 0)).sum() * (seen[1] - seen[0])
        assert found[policy] == pytest.approx(expected, abs=1e-6)


@pytest.fixture
def library():
    """Two types from ten runs a pair; the third policy pays somewhat less than the best."""
    random = np.random.default_rng(0)
    means = np.array([[1.0, 0.0, 0.7], [0.0, 1.0, 0.7]])
    return PolicyLibrary.from_samples(random.normal(means[..., None], 1.0, (2, 3, 10)))


def lived(agent, means, episodes, deviation=1.0):
    """The policies of a user with these mean pays."""
    random, chosen = np.random.default_rng(1), []
    for _ in range(episodes):
        chosen.append(agent.select())
        agent.update(chosen[-1], random.normal(means[chosen[-1]], deviation))
    return chosen


def test_a_user_whose_own_pay_differs_from_the_type_is_found_out(library):
    means = [1.0, 0.0, 2.0]
    assert 2 not in lived(BayesianPolicyReuse(library, TRIALS, models="plug-in"), means, 60)
    assert lived(BayesianPolicyReuse(library, TRIALS), means, 60)[-20:] == [2] * 20


def test_trials_end_for_a_user_who_is_as_the_type_says(library):
    chosen = lived(BayesianPolicyReuse(library, TRIALS), [1.0, 0.0, 0.3], 200)
    assert chosen[-50:].count(0) >= 48


def test_a_trial_needs_episodes_left_in_which_it_pays(library):
    agent = BayesianPolicyReuse(library)
    for _ in range(30):
        agent.update(0, 1.0)
    read = agent.algorithm.known(0)
    without, net = (TRIALS.scores(read, agent.belief, episodes_left=left) for left in (0, None))
    assert (without == InformationDirected().scores(read, agent.belief)).all()
    assert (without <= 0).all()
    tried = net > 0
    assert tried.any()
    assert (net[~tried] == without[~tried]).all()
    assert read.performance.n_shown * AHEAD > 50  # the largest number of episodes that a trial serves
    expected = read.performance.expected(agent.belief)
    gain = gain_of_trial(read.performance, agent.belief, expected)
    assert net[tried] == pytest.approx((50 * gain - expected.max() + expected)[tried])


def test_rows_of_users_and_parts_of_a_library_try_as_one_user_does(library):
    agent, users = BayesianPolicyReuse(library, TRIALS), UserBeliefs(library, 3, "f8")
    for pay in (1.2, 0.9, 1.1, 1.0) * 5:
        agent.update(0, pay)
        users.update(np.arange(3), np.zeros(3, int), np.full(3, pay))
    every = np.arange(3)
    for available in (None, [True, False, True]):
        alone = agent.probabilities(available)
        assert users.probabilities(every, TRIALS, available=available) == pytest.approx(np.tile(alone, (3, 1)))
    assert agent.probabilities([True, False, True]).tolist() == [0, 0, 1]
