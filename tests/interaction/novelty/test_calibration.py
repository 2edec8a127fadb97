import numpy as np
import pytest
from scipy.stats import norm

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.novelty.calibration import (
    NoveltyCalibration,
    calibrate,
    calibration_of,
    known_statistic,
    watch,
)
from lifelore.interaction.novelty.known_tasks import NormalTasks, known_tasks
from lifelore.interaction.novelty.novelty_statistics import NoveltyStatistics
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.selection import BeliefSampling, EpsilonGreedy, ExpectedImprovement, Greedy
from lifelore.interaction.signals.category_signal import CategorySignal

MEAN = np.array([[10.0, 4.0, 0.0], [4.0, 10.0, 4.0], [0.0, 4.0, 10.0]])
EXACT = PolicyLibrary.from_means(MEAN, 2.0)


def test_the_threshold_is_the_quantile_of_the_largest_value():
    # A single episode of standard normals: the quantile of a normal.
    statistic = 3 + 2 * np.random.default_rng(0).standard_normal((100_000, 1))
    found = calibration_of(statistic, 0.05)
    assert found.threshold == pytest.approx(norm.isf(0.05), abs=0.03)
    assert (found.mean[0], found.deviation[0]) == pytest.approx((3, 2), abs=0.03)
    assert ((found.standardised(statistic) > found.threshold).mean()) == pytest.approx(0.05, abs=1e-4)


@pytest.mark.parametrize("rate", [0.01, 0.05])
def test_false_alarms_of_exact_models_come_at_the_requested_rate(rate):
    n = 20_000
    found = calibrate(EXACT, BeliefSampling(), rate, 10, n, np.random.default_rng(0))
    others = known_statistic(EXACT, BeliefSampling(), 10, n, np.random.default_rng(1))
    alarms = (found.standardised(others) > found.threshold).any(axis=1).mean()
    # Two independent shares of n tasks: four standard errors of their difference.
    assert alarms == pytest.approx(rate, abs=4 * (2 * rate / n) ** 0.5)


def test_false_alarms_of_learnt_models_come_at_the_requested_rate():
    """Libraries from ten runs, tasks with the true parameters; and the rate would be wrong without their doubt."""
    random, rate, shares, trusting = np.random.default_rng(0), 0.05, [], []
    for _ in range(12):
        library = PolicyLibrary.from_samples(random.normal(MEAN[..., None], 2.0, (3, 3, 10)))
        found = calibrate(library, BeliefSampling(), rate, 10, 2000, random)
        statistics, types = NoveltyStatistics(library), random.integers(0, 3, 2000)
        model = library.performance
        estimates = NormalTasks(model.mean[types], model.deviation[types], random)
        blind = calibration_of(watch(statistics, BeliefSampling(), estimates, 2000, 10, random).statistic, rate)
        means = MEAN[random.integers(0, 3, 1000)]
        tasks = NormalTasks(means, np.full_like(means, 2.0), random)
        statistic = watch(statistics, BeliefSampling(), tasks, 1000, 10, random).statistic
        shares.append((found.standardised(statistic) > found.threshold).any(axis=1).mean())
        trusting.append((blind.standardised(statistic) > blind.threshold).any(axis=1).mean())
    error = np.std(shares, ddof=1) / 12**0.5
    assert np.mean(shares) == pytest.approx(rate, abs=4 * error)
    # Estimates taken for the truth miss the rate by more than a fifth.
    assert np.mean(trusting) > 1.2 * np.mean(shares)


@pytest.mark.parametrize("rule", [BeliefSampling(), Greedy(), ExpectedImprovement(), EpsilonGreedy(0.3)])
def test_statistics_stand_still_on_known_tasks_whatever_the_rule(rule):
    n = 4000
    seen = watch(
        NoveltyStatistics(EXACT),
        rule,
        known_tasks(EXACT, n, np.random.default_rng(0)),
        n,
        8,
        np.random.default_rng(1),
    )
    for array in (seen.surprise, seen.shortfall):
        assert np.abs(array.mean(axis=0)).max() < 5 / n**0.5 + 0.02
        assert array.std(axis=0) == pytest.approx(np.ones(8), abs=0.08)
    assert (seen.log_odds[:, -1] < 0).mean() > 0.9


def test_simulated_tasks_are_played_as_an_agent_plays():
    """A single agent on the same outcomes finds the same choices best, and has the same surprise."""
    random = np.random.default_rng(0)
    pays = MEAN[2] + 2 * random.standard_normal((6, 3))

    class Recorded:
        def __init__(self):
            self.chosen = []

        def signals(self, policies):
            self.chosen.append(int(policies[0]))
            return pays[len(self.chosen) - 1, policies]

    tasks = Recorded()
    seen = watch(NoveltyStatistics(EXACT), ExpectedImprovement(), tasks, 1, 6, np.random.default_rng(0))
    agent = BayesianPolicyReuse(EXACT, ExpectedImprovement())
    for episode in range(6):
        scores = agent.rule.scores(EXACT, agent.belief)
        # Equals are drawn at random.
        assert scores[tasks.chosen[episode]] == pytest.approx(scores.max())
        agent.update(tasks.chosen[episode], pays[episode, tasks.chosen[episode]])
    assert seen.raw_surprise[0, -1] == pytest.approx(agent.surprise)


def test_categories_calibrate_too():
    signal = CategorySignal([[[0.6, 0.3, 0.1]], [[0.1, 0.2, 0.7]]], categories=["a", "b", "c"])
    library = PolicyLibrary.from_means([[1.0], [2.0]], 1.0, signal=signal)
    found = calibrate(library, Greedy(), 0.05, 6, 4000, np.random.default_rng(0), signal_count=12)
    assert found.horizon == 6
    assert np.isfinite(found.threshold)


def test_bad_settings_are_refused():
    for settings, match in (
        ((0.0, 5, 1000), "false_alarm must lie between 0 and 1"),
        ((0.01, 5, 1000), "n_tasks must be at least"),
        ((0.05, 0, 1000), "horizon must be at least 1"),
    ):
        with pytest.raises(InputError, match=match):
            calibrate(EXACT, Greedy(), *settings, np.random.default_rng(0))


def test_arrays_that_are_no_calibration_are_refused():
    good = calibration_of(np.random.default_rng(0).standard_normal((1000, 3)), 0.05).to_arrays()
    again = NoveltyCalibration.from_arrays(good)
    assert again.to_arrays()["calibration"].tolist() == good["calibration"].tolist()
    for name, value in (("calibration_mean", np.zeros(2)), ("calibration_deviation", np.zeros(3))):
        with pytest.raises(InputError, match="novelty calibration must have"):
            NoveltyCalibration.from_arrays(good | {name: value})
    with pytest.raises(InputError, match="needs three numbers"):
        NoveltyCalibration.from_arrays({})
