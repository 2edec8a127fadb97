"""Protocols are met by shape alone; a record is frozen."""

import numpy as np

from lifelore.core.protocols import Policy, SignalModel, World


class Coin:
    n_actions = 2

    def reset(self, task, seed):
        return 0

    def step(self, action):
        return 0, 1.0, True, False

    def context(self, state, last_reward):
        return state


class Loudness:
    def log_likelihood(self, policy, signal):
        return np.array([0.0, -np.inf])


def test_met_by_shape():
    assert isinstance(Coin(), World)
    assert isinstance(Loudness(), SignalModel)
    assert isinstance(lambda state: 0, Policy)
    assert not isinstance(Loudness(), World)
    assert not isinstance(Coin(), SignalModel)
    assert not isinstance(np.zeros(3, int), Policy)  # arrays serve where callers index them, not as calls
