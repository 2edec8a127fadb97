"""The telephone service by hand and by many calls."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.telephone.telephone import (
    ANGRY,
    ANNOYED,
    FRUSTRATED,
    HUNG_UP,
    PATHS,
    REWARD_SEQUENCES,
    START,
    SUCCESS,
    Telephone,
    rewards_of,
)


def test_calls_there_can_be():
    assert len(PATHS) == 7
    assert PATHS[0] == (START, SUCCESS)
    assert PATHS[-1] == (START, FRUSTRATED, ANNOYED, ANGRY)
    assert len(REWARD_SEQUENCES) == 6
    for path in PATHS:
        assert sum(rewards_of(path)) == (10 if path[-1] == SUCCESS else 3)
    # As the text says: an unsuccessful end pays the same whichever it is.
    assert rewards_of(PATHS[-1]) == rewards_of((START, FRUSTRATED, ANNOYED, HUNG_UP))


def test_reading_a_by_hand():
    phone = Telephone(n_models=4)
    # Type 0 and model 1: ρ = 3/4, so irritated 0.3, success 0.7 · 0.75 = 0.525, hung up 0.175.
    assert phone.outcome_probs[0, 1] == pytest.approx([0.3, 0.525, 0.175])
    expected = [0.525, 0.175, 0.3 * 0.525, 0.3 * 0.175, 0.09 * 0.525, 0.09 * 0.175, 0.027]
    assert phone.path_probs[0, 1] == pytest.approx(expected)
    assert phone.reward_probs[0, 1] == pytest.approx([*expected[:5], 0.09 * 0.175 + 0.027])
    solved = 0.525 * (1 + 0.3 + 0.09)
    assert phone.utility_probs[0, 1] == pytest.approx([1 - solved, solved])
    assert phone.mean[0, 1] == pytest.approx(3 + 7 * solved)


def test_reading_b_by_hand():
    phone = Telephone(n_models=4, reading="B")
    # Success 0.75; of what fails, 0.3 is irritated and 0.7 hangs up.
    assert phone.outcome_probs[0, 1] == pytest.approx([0.075, 0.75, 0.175])
    assert phone.mean[0, 1] == pytest.approx(3 + 7 * 0.75 * (1 + 0.075 + 0.075**2))


@pytest.mark.parametrize("reading", ["A", "B"])
def test_the_preferred_model_never_fails_and_is_alone_the_best(reading):
    phone = Telephone(n_models=7, reading=reading)
    assert phone.mean.diagonal() == pytest.approx(np.full(7, 10.0))
    assert (phone.mean + np.eye(7) * -1 < 10).all()
    assert (phone.mean.argmax(axis=1) == np.arange(7)).all()
    # The farther the model, the worse.
    assert (np.diff(phone.mean[0]) < 0).all()


def _information(probs):
    """Mutual information of the type with a signal under each policy, nats, types uniform."""
    mixture = probs.mean(axis=0)
    ratio = np.divide(probs, mixture, out=np.ones_like(probs), where=probs > 0)
    return (probs * np.log(ratio)).sum(axis=-1).mean(axis=0)


def test_only_under_reading_a_do_states_tell_more_than_rewards():
    a, b = Telephone(10, reading="A"), Telephone(10, reading="B")
    assert (_information(a.path_probs) > _information(a.reward_probs) + 1e-4).all()
    assert (_information(a.reward_probs) > _information(a.utility_probs) + 1e-3).all()
    # Under B the ways to angry and to hanging up when annoyed are in the ratio η : 1 − η for every type.
    assert _information(b.path_probs) == pytest.approx(_information(b.reward_probs), abs=1e-12)


def test_only_under_reading_a_is_the_way_to_angry_independent_of_the_type():
    for reading, same in (("A", True), ("B", False)):
        to_angry = Telephone(10, reading=reading).transition_probs[:, 0, ANNOYED, ANGRY][1:]
        assert np.allclose(to_angry, to_angry[0]) is same


def test_one_failure_rules_a_preference_out_for_ever():
    probs = Telephone(10).path_probs[3, 3]
    assert probs.tolist() == [1, 0, 0, 0, 0, 0, 0]


@pytest.mark.parametrize(
    ("changes", "error", "rule"),
    [
        ({"n_models": 0}, InputError, "n_models must be at least 1"),
        ({"eta": 1.0}, InputError, "must lie in"),
        ({"reading": "C"}, NotFoundError, "reading must be one of A, B"),
    ],
)
def test_services_that_cannot_be(changes, error, rule):
    with pytest.raises(error, match=rule):
        Telephone(**changes)
