"""Bandits with pseudo-pulls: beliefs and regret by hand; UCB1 itself is tested with the baselines."""

import numpy as np
import pytest

from reproduction.chapter5.c5_03_priors_in_search.run import BANDITS, BetaThompson, regret


def test_beliefs_of_thompson_sampling_by_hand():
    player = BetaThompson(1, n_tasks=40_000, seed=0)
    player.arms.pulls[:], player.arms.mean[:] = 6.0, 4 / 6
    # Beta(5, 3): mean 5/8, variance 15/576. Five standard errors of the mean are 0.004.
    draws = player._scores()
    assert draws.mean() == pytest.approx(5 / 8, abs=0.005)
    assert draws.var() == pytest.approx(15 / 576, rel=0.05)


@pytest.mark.parametrize("name", BANDITS)
def test_regret_by_hand(name):
    """Two problems of two arms: so many pseudo-pulls decide each of ten pulls, rightly or wrongly."""
    theta, means = np.array([[1.0, 0.0], [1.0, 0.0]]), np.array([[0.9, 0.2], [0.3, 0.5]])
    payoffs = np.ones((2, 10, 2))
    lost = regret(name, theta, np.array([[1e6], [1e6]]), payoffs, means, np.random.default_rng(0))
    assert lost == pytest.approx([0.0, 2.0])
    # Without any, both arms are pulled, and neither wins.
    assert 0 < regret(name, 0 * theta, 0.0, payoffs, means, np.random.default_rng(0))[0] < 7
