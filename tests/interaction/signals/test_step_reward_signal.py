"""(s, a, r) tuples as signals, by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.signals.step_reward_signal import StepRewardSignal

EPISODES = [(0, 0, [(0, 0, 5.0), (1, 0, 0.0)]), (1, 0, [(0, 0, 0.0)])]


def test_fitted_by_hand():
    signal = StepRewardSignal.from_sequences(EPISODES, rewards=[0.0, 5.0], n_types=2, n_states=2)
    np.testing.assert_allclose(signal.probs[:, 0, 0], [[0.25, 0.75], [0.75, 0.25]])
    np.testing.assert_allclose(signal.log_likelihood(0, [(0, 0, 5.0), (0, 0, 5.0)]), 2 * np.log([0.75, 0.25]))
    np.testing.assert_allclose(signal.take(types=[1]).log_likelihood(0, [(0, 0, 5.0)]), np.log([0.25]))
    assert signal.n_entries == 2 * 2 * 2


def test_bad_input_is_refused():
    signal = StepRewardSignal.from_sequences(EPISODES, [0.0, 5.0], 2, 2)
    for bad, message in [
        ([(0, 0, 3.0)], "reward 3.0 is not among"),
        ([(0, 0, np.nan)], "reward nan is not among"),
        ([(5, 0, 0.0)], "each step must be below"),
        ([(0, 0.0)], "rows of"),
        (7, "rows of"),
    ]:
        with pytest.raises(InputError, match=message):
            signal.log_likelihood(0, bad)
    with pytest.raises(InputError, match="distinct finite numbers"):
        StepRewardSignal([0.0, 0.0], np.full((1, 1, 1, 2), 0.5))
