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
