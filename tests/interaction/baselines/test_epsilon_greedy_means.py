import numpy as np
import pytest

from lifelore.interaction.baselines import EpsilonGreedyMeans


def test_the_best_mean_is_played_but_for_a_share():
    player = EpsilonGreedyMeans(4, epsilon=0.4, prior_means=[0.1, 0.9, 0.2, 0.3], n_tasks=20_000, seed=1)
    shares = np.bincount(player.select(), minlength=4) / 20_000
    # 0.6 + 0.4/4 for the best, 0.1 for the others; five deviations are at most 0.0163.
    assert shares == pytest.approx([0.1, 0.7, 0.1, 0.1], abs=0.0163)


def test_means_with_and_without_a_prior():
    fresh = EpsilonGreedyMeans(3, epsilon=0, seed=0)
    fresh.update(0, 100.0)
    assert fresh.select() in (1, 2)
    known = EpsilonGreedyMeans(3, epsilon=0, prior_means=[0, 1, 2], prior_pulls=[1, 1, 3])
    known.update(2, -4.0)
    # (2 · 3 - 4) / 4 = 0.5.
    assert known.arms.mean[0].tolist() == [0.0, 1.0, 0.5]
    assert known.select() == 1
