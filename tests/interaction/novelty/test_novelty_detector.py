import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.beliefs.belief import entropy
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.novelty.novelty_detector import NoveltyDetector
from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
from lifelore.interaction.signals.category_signal import CategorySignal

LIBRARY = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 1.0, policies=["left", "right"])
DETECTOR = NoveltyDetector.calibrate(LIBRARY, false_alarm=0.02, horizon=12, n_tasks=2000)


def _played(pay, episodes=8, noise=1.0, seed=0):
    agent, detector = BayesianPolicyReuse(LIBRARY, seed=seed), DETECTOR.restart()
    random = np.random.default_rng(seed)
    for _ in range(episodes):
        policy = agent.select()
        detector.update(agent, policy, pay[policy] + noise * random.standard_normal())
    return agent, detector


def test_a_known_user_raises_no_alarm_and_is_probably_known():
    for seed in range(5):
        _, detector = _played([10.0, 0.0], seed=seed)
        assert not detector.alarm
        assert detector.alarm_episode is None
        assert detector.probability < 0.05


def test_a_user_whom_no_type_fits_raises_an_alarm():
    for seed in range(5):
        _, detector = _played([5.0, 5.0], seed=seed)
        assert detector.alarm
        assert detector.alarm_episode <= 3
        assert detector.probability > 0.9
        assert detector.shortfall > 3


def test_surprise_falls_for_known_users_at_small_noise_and_the_detector_is_silent():
    """Why the raw surprise is no sign of a new type: a known user lowers it without end."""
    library = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 0.01)
    detector = NoveltyDetector.calibrate(library, false_alarm=0.02, horizon=10, n_tasks=1000)
    agent, random = BayesianPolicyReuse(library), np.random.default_rng(0)
    raw = []
    for _ in range(10):
        policy = agent.select()
        detector.update(agent, policy, [10.0, 0.0][policy] + 0.01 * random.standard_normal())
        raw.append(agent.surprise)
    assert raw[-1] < -20
    assert not detector.alarm


def test_the_belief_in_a_wrong_type_is_narrow_and_the_detector_sees_it():
    """Errata: the thesis takes a spread belief as the sign of a new type."""
    agent, detector = _played([6.0, 3.0])  # nearer to the first type, and far from both
    assert entropy(agent.belief) < 0.05
    assert detector.alarm


def test_the_belief_of_the_agent_is_not_disturbed():
    agent, _ = _played([5.0, 5.0])
    alone, random = BayesianPolicyReuse(LIBRARY, seed=0), np.random.default_rng(0)
    for _ in range(8):
        alone.update(alone.select(), 5.0 + random.standard_normal())
    assert np.array_equal(agent.log_belief, alone.log_belief)


def test_the_probability_is_bayes_rule_with_the_prior_mass():
    likely, unlikely = (NoveltyDetector(LIBRARY, DETECTOR.calibration, mass) for mass in (0.5, 0.001))
    assert (likely.probability, unlikely.probability) == (pytest.approx(0.5), pytest.approx(0.001))
    for detector in (likely, unlikely):
        detector.observe([0.5, 0.5], "left", 6.0)
    odds = [detector.probability / (1 - detector.probability) for detector in (likely, unlikely)]
    assert odds[0] / odds[1] == pytest.approx(999)


def test_no_alarm_after_the_horizon():
    detector = DETECTOR.restart()
    for _ in range(DETECTOR.calibration.horizon):
        detector.observe([1.0, 0.0], "left", 10.0)
    for _ in range(20):
        detector.observe([1.0, 0.0], "left", 4.0)
    assert detector.score > detector.calibration.threshold
    assert not detector.alarm


def test_a_restarted_detector_has_seen_nothing():
    _, used = _played([5.0, 5.0])
    fresh = used.restart()
    assert (fresh.episodes, fresh.alarm, fresh.score, fresh.surprise) == (0, False, 0.0, 0.0)
    assert fresh.calibration is used.calibration
    assert used.episodes == 8


def test_arrays_restore_every_bit():
    _, detector = _played([5.0, 6.0])
    arrays = detector.to_arrays()
    again = NoveltyDetector.from_arrays(LIBRARY, arrays)
    for one in (detector, again):
        one.observe([0.3, 0.7], "right", 4.0)
    assert (again.score, again.probability, again.alarm_episode) == (
        detector.score,
        detector.probability,
        detector.alarm_episode,
    )
    assert sum(array.nbytes for array in arrays.values()) < 600
    with pytest.raises(InputError, match="no novelty detector of this library"):
        NoveltyDetector.from_arrays(LIBRARY, {**arrays, "tried": np.array([7])})
    with pytest.raises(InputError):
        NoveltyDetector.from_arrays(LIBRARY, {})


def test_bad_signals_change_nothing():
    agent, detector = BayesianPolicyReuse(LIBRARY), DETECTOR.restart()
    with pytest.raises(InputError, match="finite number"):
        detector.update(agent, "left", np.nan)
    with pytest.raises(NotFoundError):
        detector.update(agent, "up", 1.0)
    with pytest.raises(InputError, match=r"belief must be \(2,\)"):
        detector.observe([1.0], "left", 1.0)
    assert (detector.episodes, agent.episode) == (0, 0)
    with pytest.raises(InputError, match="mass must lie between 0 and 1"):
        NoveltyDetector(LIBRARY, DETECTOR.calibration, 1.0)


def test_categories_by_name():
    probs = [[[0.9, 0.05, 0.05]], [[0.05, 0.9, 0.05]]]
    signal = CategorySignal(probs, categories=["near", "middle", "far"])
    library = PolicyLibrary.from_means([[1.0], [2.0]], 1.0, signal=signal)
    detector = NoveltyDetector.calibrate(library, false_alarm=0.05, horizon=10, n_tasks=1000)
    agent = BayesianPolicyReuse(library)
    for _ in range(10):
        detector.update(agent, 0, "far")
    assert detector.alarm
    assert detector.probability > 0.9
    assert detector.shortfall == 0


@settings(max_examples=50, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 1), st.floats(-1e100, 1e100)), max_size=20))
def test_answers_are_finite_whatever_the_outcomes(signals):
    agent, detector = BayesianPolicyReuse(LIBRARY), DETECTOR.restart()
    for policy, value in signals:
        detector.update(agent, policy, value)
    assert np.isfinite([detector.score, detector.surprise, detector.shortfall]).all()
    assert 0 <= detector.probability <= 1
