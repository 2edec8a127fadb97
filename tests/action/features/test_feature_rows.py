"""Rows by features of the last reward: by hand, against the codes of each step, and learning that needs them."""

import numpy as np
import pytest

from lifelore.action.features.feature_function import (
    JoinedFeatures,
    LastReward,
    StateFeatures,
    TaskFeature,
    context_codes,
)
from lifelore.action.features.feature_rows import feature_rows
from lifelore.action.features.feature_set import FeatureSet
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.mdp import Tables

SIDES = StateFeatures(FeatureSet(("side",), (2,)), np.array([[0], [1], [0], [1]]))


def drawn(seed: int, n_rewards: int = 5) -> Tables:
    random = np.random.default_rng(seed)
    rewards = random.integers(-n_rewards // 2, n_rewards // 2 + 1, (4, 2, 4))
    return Tables.from_matrices(random.dirichlet(np.ones(4), (4, 2)), rewards, terminal=[])


def distinct(codes):
    """Probabilities that name their code."""
    codes = np.asarray(codes, float)[:, None]
    return np.hstack([(codes + 1) / 100, 1 - (codes + 1) / 100])


@pytest.mark.parametrize("edges", [(0.0,), (-1.0, 1.0), (0.5, 1.5)])
def test_each_step_reads_the_codes_of_its_state_and_last_reward(edges):
    tables, phi = drawn(1), JoinedFeatures((SIDES, TaskFeature("task", 3, int), LastReward(edges)))
    rows = feature_rows(tables, phi, distinct, task=2)
    for state in range(4):
        start = context_codes(phi, [state], 2, 0.0)
        assert rows.explore_cum[rows.context_row[state, 0], 0] == pytest.approx(distinct(start)[0, 0])
    for (s, a, k), reward in np.ndenumerate(tables.reward):
        following = tables.next_state[s, a, k]
        code = context_codes(phi, [following], 2, reward)
        row = rows.context_row[following, rows.reward_class[s, a, k]]
        assert rows.explore_cum[row, 0] == pytest.approx(distinct(code)[0, 0])
    assert rows.context_row.shape == (4, len(edges) + 1)


def test_a_prior_that_knows_the_last_reward_collects_more():
    # In a single state action 0 pays after a reward, and action 1 after none: only φ(last reward) tells which.
    # States 0 and 1 are that place without and with a reward just paid; the learner cannot see which.
    transitions = np.zeros((2, 2, 2))
    transitions[0, 0, 0] = transitions[0, 1, 1] = transitions[1, 0, 1] = transitions[1, 1, 0] = 1
    tables = Tables.from_matrices(transitions, [0.0, 1.0], starts=[0])
    blind = StateFeatures(FeatureSet(("place",), (1,)), np.zeros((2, 1), int))
    phi = JoinedFeatures((blind, LastReward((0.5,))))
    prior = ActionPrior(2, alpha0=0.01)
    prior.update(context_codes(phi, [0, 0], last_rewards=[0.0, 1.0]), [[False, True], [True, False]])
    explore = QLearning(50, max_steps=20, epsilon=1.0, epsilon_decay=1.0)
    means = [
        explore.learn(tables, 0.9, rows=feature_rows(tables, each, prior.probs))[1].rewards.mean()
        for each in (phi, blind)
    ]
    assert means[0] > 19  # of 20
    assert means[1] < 12


def test_more_rewards_than_a_byte_holds():
    tables = Tables.from_matrices(np.full((20, 2, 20), 0.05), np.arange(800.0).reshape(20, 2, 20), terminal=[])
    states = StateFeatures(FeatureSet((), ()), np.zeros((20, 0), int))
    with pytest.raises(InputError, match="phi must tell at most 256 classes of rewards apart, got 800"):
        feature_rows(tables, JoinedFeatures((states, LastReward(tuple(np.arange(0.5, 800))))), distinct)
