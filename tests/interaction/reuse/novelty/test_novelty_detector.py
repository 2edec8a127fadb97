import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.metrics import entropy
from lifelore.interaction import BayesianPolicyReuse, NoveltyDetector, PolicyLibrary, TypeDynamics

LIBRARY = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 1.0, policies=["left", "right"])
DETECTOR = NoveltyDetector.calibrate(LIBRARY, false_alarm=0.02, horizon=12, n_tasks=2000)


def _played(pay, episodes=8, noise=1.0, seed=0):
    agent = BayesianPolicyReuse(LIBRARY, seed=seed, novelty=DETECTOR.restart())
    random = np.random.default_rng(seed)
    for _ in range(episodes):
        policy = agent.select()
        agent.update(policy, pay[policy] + noise * random.standard_normal())
    assert agent.novelty is not None
    return agent, agent.novelty


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
        assert detector.alarm_episode is not None
        assert detector.alarm_episode <= 3
        assert detector.probability > 0.9


def test_the_belief_in_a_wrong_type_is_narrow_and_the_detector_sees_it():
    """Errata: the thesis takes a spread belief as the sign of a new type."""
    agent, detector = _played([6.0, 3.0])  # nearer to the first type, and far from both
    assert entropy(agent.belief) < 0.05
    assert detector.alarm


def test_the_probability_is_bayes_rule_with_the_prior_mass():
    likely, unlikely = (NoveltyDetector(LIBRARY, mass) for mass in (0.5, 0.001))
    assert (likely.probability, unlikely.probability) == (pytest.approx(0.5), pytest.approx(0.001))
    for detector in (likely, unlikely):
        detector.observe("left", 6.0)
    odds = [detector.probability / (1 - detector.probability) for detector in (likely, unlikely)]
    assert odds[0] / odds[1] == pytest.approx(999)


@pytest.mark.parametrize("models", ["uncertain", "plug-in"])
@pytest.mark.parametrize("kind", ["gaussian", "categorical"])
def test_a_restored_state_has_the_same_bits(kind, models):
    samples = np.round(np.random.default_rng(0).normal([[[2.0]], [[5.0]]], 1.0, (2, 3, 10)))
    library, dynamics = PolicyLibrary.from_samples(samples, model=kind), TypeDynamics.static()
    agent = {"models": models, "dynamics": dynamics}
    detector = NoveltyDetector.calibrate(library, "sampling", false_alarm=0.1, horizon=5, n_tasks=200, **agent)
    for policy, value in ((2, 3.0), (0, 5.0), (2, 2.0), (2, 4.0)):
        detector.update(policy, value)
    state = detector.state()
    again = NoveltyDetector.restored(state, library, dynamics, models)
    for one in (detector, again):
        one.update(1, 4.0)
    for name in ("probability", "score", "alarm_episode", "n_signals", "mass"):
        assert getattr(again, name) == getattr(detector, name)
    assert {name: array.tobytes() for name, array in again.state().items()} == {
        name: array.tobytes() for name, array in detector.state().items()
    }


def test_earlier_states_that_took_bins_for_normal_outcomes_are_read():
    samples = np.random.default_rng(0).normal([[[2.0]], [[5.0]]], 1.0, (2, 3, 60))
    library = PolicyLibrary.from_samples(samples, model="histogram")
    state = NoveltyDetector(library).state()
    del state["log_odds"]
    earlier = {"places": np.array([[1]]), "shown": np.array([[4.0, 2.0, 1.0]]), "numbers": np.array([0.1, 0.5])}
    detector = NoveltyDetector.restored(state | earlier, library)
    assert detector.log_odds == pytest.approx(0.5)
    detector.update(1, 2.0)


def test_a_calibration_of_outcomes_by_the_earlier_statistic_raises_no_alarm():
    detector = DETECTOR.restart()
    detector.update("left", 7.0)
    earlier = {"misfit": np.array([1.0, 0.3, 1.0, -1]), "misfit_by_type": np.array([2.0, 3.0])}
    with pytest.warns(UserWarning, match="until it is calibrated again"):
        again = NoveltyDetector.restored(detector.state() | earlier, LIBRARY)
    for _ in range(5):
        again.update("left", 5.0)  # no type pays 5
    assert not again.alarm
    with pytest.warns(UserWarning, match="until it is calibrated again"):
        assert not NoveltyDetector.restored(again.state(), LIBRARY).alarm


def test_an_alarm_of_the_earlier_statistic_stays():
    detector = DETECTOR.restart()
    detector.update("left", 7.0)
    earlier = {"misfit": np.array([1.0, 0.3, 1.0, 2]), "misfit_by_type": np.array([2.0, 3.0])}
    again = NoveltyDetector.restored(detector.state() | earlier, LIBRARY)
    again.update("left", 5.0)
    assert again.alarm
    assert NoveltyDetector.restored(again.state(), LIBRARY).alarm


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"places": np.array([[7]])}, "must have places below"),
        ({"log_belief": np.zeros(9)}, "log_belief must be"),
        ({"shown": np.zeros((1, 2))}, "must have rows of 3 numbers"),
        ({"shown": np.full((1, 3), np.nan)}, "must have rows of 3 numbers"),
        ({"numbers": np.array([2.0, 0.0])}, "between 0 and 1"),
        ({"numbers": np.array([0.5])}, "no evidence of an unknown type"),
        ({"numbers": np.array([0.5, np.nan])}, "must be finite"),
        ({"misfit": np.zeros(2)}, "no evidence of an unknown type"),
        ({"misfit_by_type": np.zeros(9)}, "no evidence of an unknown type"),
        ({"calibration_by_signal": np.zeros((2, 12))}, "novelty calibration must have"),
    ],
)
def test_states_that_are_none_are_refused(change, message):
    detector = DETECTOR.restart()
    detector.update("left", 7.0)
    with pytest.raises(InputError, match=message):
        NoveltyDetector.restored(detector.state() | change, LIBRARY)
