import numpy as np
import pytest
from scipy.stats import norm

from lifelore.core.errors import InputError
from lifelore.core.metrics import entropy
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.reuse.novelty.calibration import NoveltyCalibration, check_rate, known_statistic, watch
from lifelore.interaction.reuse.novelty.known_tasks import normal_tasks
from lifelore.interaction.reuse.novelty.novelty_detector import NoveltyDetector
from lifelore.interaction.selection import BeliefSampling, ExpectedImprovement, Greedy

MEAN = np.array([[10.0, 4.0, 0.0], [4.0, 10.0, 4.0], [0.0, 4.0, 10.0]])
EXACT = PolicyLibrary.from_means(MEAN, 2.0)


def test_the_threshold_is_the_quantile_of_the_largest_value():
    # A single episode of standard normals: the quantile of a normal.
    statistic = 3 + 2 * np.random.default_rng(0).standard_normal((100_000, 1))
    found = NoveltyCalibration.of(statistic, 0.05)
    assert found.threshold == pytest.approx(norm.isf(0.05), abs=0.03)
    assert (found.mean[0], found.deviation[0]) == pytest.approx((3, 2), abs=0.03)
    assert ((found.standardised(statistic) > found.threshold).mean()) == pytest.approx(0.05, abs=1e-4)


def test_false_alarms_of_exact_models_come_at_the_requested_rate():
    n, rate = 20_000, 0.05
    found = NoveltyCalibration.of(known_statistic(EXACT, BeliefSampling(), 10, n, np.random.default_rng(0)), rate)
    others = known_statistic(EXACT, BeliefSampling(), 10, n, np.random.default_rng(1))
    alarms = (found.standardised(others) > found.threshold).any(axis=1).mean()
    # Two independent shares of n tasks: four standard errors of their difference.
    assert alarms == pytest.approx(rate, abs=4 * (2 * rate / n) ** 0.5)


def test_false_alarms_of_learnt_models_come_at_the_requested_rate():
    """Libraries from ten runs, tasks with the true parameters."""
    random, rate, shares = np.random.default_rng(0), 0.05, []
    for _ in range(8):
        library = PolicyLibrary.from_samples(random.normal(MEAN[..., None], 2.0, (3, 3, 10)))
        found = NoveltyCalibration.of(known_statistic(library, BeliefSampling(), 10, 2000, random), rate)
        means = MEAN[random.integers(0, 3, 1000)]
        tasks = normal_tasks(means, np.full_like(means, 2.0), random)
        statistic = watch(library, BeliefSampling(), tasks, 1000, 10, random).statistic
        shares.append((found.standardised(statistic) > found.threshold).any(axis=1).mean())
    error = np.std(shares, ddof=1) / 8**0.5
    assert np.mean(shares) == pytest.approx(rate, abs=4 * error)


def test_simulated_tasks_are_played_as_an_agent_plays():
    """A single agent on the same outcomes has the same belief, log odds and statistic."""
    random = np.random.default_rng(0)
    pays = MEAN[2] + 2 * random.standard_normal((6, 3))

    chosen = []

    def tasks(policies):
        chosen.append(int(policies[0]))
        return pays[len(chosen) - 1, policies]

    seen = watch(EXACT, ExpectedImprovement(), tasks, 1, 6, np.random.default_rng(0))
    plain = NoveltyCalibration(0.05, np.zeros(6), np.ones(6), 99.0, 400)
    agent = BayesianPolicyReuse(EXACT, ExpectedImprovement(), novelty=NoveltyDetector(EXACT, calibration=plain))
    for episode in range(6):
        assert entropy(agent.belief) == pytest.approx(seen.entropy[0, episode])
        scores = agent.rule.scores(EXACT, agent.belief)
        # Equals are drawn at random.
        assert scores[chosen[episode]] == pytest.approx(scores.max())
        agent.update(chosen[episode], float(pays[episode, chosen[episode]]))
        assert agent.novelty.score == pytest.approx(seen.statistic[0, episode])


def test_bad_settings_are_refused():
    with pytest.raises(InputError, match="false_alarm must lie between 0 and 1"):
        check_rate(0.0, 1000)
    with pytest.raises(InputError, match="n_tasks must be at least"):
        check_rate(0.01, 1000)
    with pytest.raises(InputError, match="horizon must be at least 1"):
        known_statistic(EXACT, Greedy(), 0, 1000, np.random.default_rng(0))


def test_arrays_that_are_no_calibration_are_refused():
    good = NoveltyCalibration.of(np.random.default_rng(0).standard_normal((1000, 3)), 0.05).to_arrays()
    again = NoveltyCalibration.from_arrays(good)
    assert again.to_arrays()["calibration"].tolist() == good["calibration"].tolist()
    for value in (np.zeros((2, 3)), np.full((2, 3), np.nan)):
        with pytest.raises(InputError, match="novelty calibration must have"):
            NoveltyCalibration.from_arrays(good | {"calibration_by_signal": value})
    with pytest.raises(InputError, match="needs three numbers"):
        NoveltyCalibration.from_arrays(good | {"calibration_by_signal": np.zeros(3)})
    with pytest.raises(InputError, match="needs three numbers"):
        NoveltyCalibration.from_arrays({})
