"""Sequences of rewards as signals, by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.signals.reward_signal import RewardSignal

EPISODES = [(0, 0, [1.0, 1.0, 0.0]), (1, 0, [0.0]), (1, 0, [0.0, 0.0])]


def test_likelihood_is_the_product_over_rewards():
    signal = RewardSignal.from_sequences(EPISODES, n_types=2, n_policies=1)
    # With pseudo-counts of a half: P(1) = 2.5 / 4 and 0.5 / 4.
    one = np.log([2.5 / 4, 0.5 / 4])
    none = np.log([1.5 / 4, 3.5 / 4])
    np.testing.assert_allclose(signal.log_likelihood(0, [1, 0, 0]), one + 2 * none)
    assert signal.log_likelihood(0, []).tolist() == [0.0, 0.0]


def test_rewards_may_be_gaussian():
    signal = RewardSignal(GaussianOutcomes([[0.0], [3.0]], 1.0))
    expected = sum(signal.rewards.log_density(0, reward) for reward in (0.5, 2.0))
    np.testing.assert_allclose(signal.log_likelihood(0, [0.5, 2.0]), expected)
    fitted = RewardSignal.from_sequences(EPISODES, 2, 1, model="gaussian", shrinkage=3.0)
    assert isinstance(fitted.rewards, GaussianOutcomes)
    assert fitted.take(types=[1]).n_types == 1


def test_bad_input_is_refused():
    signal = RewardSignal.from_sequences(EPISODES, 2, 1)
    for bad in ([np.nan], [np.inf], [1e200], [[1.0]], "ab", 3.0):
        with pytest.raises(InputError, match="signal of rewards must be"):
            signal.log_likelihood(0, bad)
    with pytest.raises(NotFoundError, match="unknown policy"):
        signal.log_likelihood(1, [1.0])
    with pytest.raises(InputError, match="at least one episode"):
        RewardSignal.from_sequences([], 2, 1)
    with pytest.raises(InputError, match="must name types 0 to 1"):
        RewardSignal.from_sequences([(2, 0, [1.0])], 2, 1)
    with pytest.raises(InputError, match="needs a sample"):
        RewardSignal.from_sequences(EPISODES, 3, 1)
