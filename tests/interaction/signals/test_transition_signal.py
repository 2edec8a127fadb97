"""(s, a, s') tuples as signals: fitted and read by hand, shared by policies or not."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.signals.step_model import step_probs
from lifelore.interaction.signals.transition_signal import TransitionSignal

EPISODES = [(0, 0, [(0, 0, 1), (1, 1, 0)]), (1, 0, [(0, 0, 0)]), (1, 1, [(0, 0, 1)])]


def test_counts_become_probabilities():
    counts = [[3, 1], [0, 0]]
    for pseudo_count, expected, totals in (
        (0.5, [[0.7, 0.3], [0.5, 0.5]], [5, 1]),
        (0, [[0.75, 0.25], [0.5, 0.5]], [4, 1]),
    ):
        probs, behind = step_probs(counts, pseudo_count, None)
        np.testing.assert_allclose(probs, expected)
        assert behind.tolist() == totals
    with pytest.raises(InputError, match="counts must be"):
        step_probs([[np.inf]], 0.5, None)


def test_fitted_by_hand_and_shared_by_all_policies():
    signal = TransitionSignal.from_sequences(EPISODES, n_types=2, n_states=2, n_actions=2)
    assert signal.probs.shape == (2, 2, 2, 2)
    np.testing.assert_allclose(signal.probs[0, 0, 0], [0.25, 0.75])
    np.testing.assert_allclose(signal.probs[1, 0, 0], [0.5, 0.5])
    # Nothing seen: as likely either way.
    np.testing.assert_allclose(signal.probs[1, 1, 1], [0.5, 0.5])
    expected = np.log([0.75, 0.5]) + np.log([0.75, 0.5])
    np.testing.assert_allclose(signal.log_likelihood(17, [(0, 0, 1), (1, 1, 0)]), expected)
    assert signal.log_likelihood(0, []).tolist() == [0.0, 0.0]


def test_each_policy_may_have_a_table_of_its_own():
    signal = TransitionSignal.from_sequences(EPISODES, 2, 2, 2, n_policies=2)
    assert signal.probs.shape == (2, 2, 2, 2, 2)
    np.testing.assert_allclose(signal.log_likelihood(1, [(0, 0, 1)]), np.log([0.5, 0.75]))
    with pytest.raises(NotFoundError, match="unknown policy"):
        signal.log_likelihood(2, [(0, 0, 1)])
    only = signal.take(types=[1], policies=[1])
    np.testing.assert_allclose(only.log_likelihood(0, [(0, 0, 1)]), np.log([0.75]))


def test_pseudo_counts_only_where_a_step_may_lead():
    possible = np.array([[[True, True, False]]] * 3)
    counts = np.zeros((1, 3, 1, 3))
    counts[0, 0, 0] = [3, 0, 0]
    counts[0, 1, 0] = [0, 0, 2]
    signal = TransitionSignal.from_counts(counts, possible=possible)
    np.testing.assert_allclose(
        signal.probs[0, :, 0], [[3.5 / 4, 0.5 / 4, 0], [0.5 / 3, 0.5 / 3, 2 / 3], [0.5, 0.5, 0]]
    )


def test_bad_input_is_refused():
    signal = TransitionSignal.from_sequences(EPISODES, 2, 2, 2)
    for bad, message in [
        ([(0, 0, 2)], "each step must be below"),
        ([(-1, 0, 0)], "each step must be below"),
        ([(0, 0, 0.5)], "whole numbers"),
        ([(0, 0, np.nan)], "whole numbers|rows of"),
        ([(0, 0, 0, 0)], "2 or 3 columns"),
        ("abc", "rows of"),
        ([(0, 0, 1), (0, 1)], "rows of"),
    ]:
        with pytest.raises(InputError, match=message):
            signal.log_likelihood(0, bad)
    with pytest.raises(InputError, match="from states to states"):
        TransitionSignal(np.full((1, 2, 1, 3), 1 / 3))
    with pytest.raises(InputError, match="sum to 1"):
        TransitionSignal(np.ones((1, 2, 1, 2)))
    with pytest.raises(InputError, match="must name known types"):
        TransitionSignal.from_sequences([(2, 0, [(0, 0, 1)])], 2, 2)
    with pytest.raises(InputError, match="counts must be at least 0"):
        TransitionSignal.from_counts(np.full((1, 2, 1, 2), -1.0))
    with pytest.raises(InputError, match="pseudo_count"):
        TransitionSignal.from_counts(np.ones((1, 2, 1, 2)), pseudo_count=np.nan)
