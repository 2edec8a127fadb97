"""Bandits by hand and against a plain twin, one problem at a time."""

import math

import numpy as np
import pytest

from lifelore.core.errors import InputError
from reproduction.chapter5.c5_03_priors_in_search.bandit import (
    Arms,
    beta_thompson,
    flat_arms,
    play,
    prior_arms,
    regret,
    ucb1,
)


def random():
    return np.random.default_rng(0)


def test_ucb1_by_hand():
    arms = Arms(np.array([[4.0, 1.0, 0.0]]), np.array([[3.0, 0.0, 0.0]]))
    bounds = ucb1(arms, random())[0]
    assert bounds[0] == pytest.approx(3 / 4 + math.sqrt(2 * math.log(5) / 4))
    assert bounds[1] == pytest.approx(math.sqrt(2 * math.log(5)))
    assert bounds[2] == np.inf


def naive_ucb1(payoffs, pulls, paid, uniform):
    """One problem; `uniform` (horizon, n_arms) breaks ties."""
    pulled = []
    for t in range(len(payoffs)):
        worth = [
            paid[a] / pulls[a] + math.sqrt(2 * math.log(max(1.0, sum(pulls))) / pulls[a]) if pulls[a] else math.inf
            for a in range(len(pulls))
        ]
        equals = [a for a in range(len(pulls)) if worth[a] == max(worth)]
        arm = max(equals, key=lambda a: uniform[t, a])
        pulled.append(arm)
        pulls[arm] += 1
        paid[arm] += payoffs[t, arm]
    return pulled


@pytest.mark.parametrize("strength", [0.0, 0.5, 4.0])
def test_play_is_the_plain_twin(strength):
    theta = random().dirichlet(np.ones(3), 5)
    payoffs = (random().random((5, 60, 3)) < 0.4).astype(float)
    pulled = play(ucb1, prior_arms(theta, strength), payoffs, np.random.default_rng(7))
    uniform = np.random.default_rng(7).random((60, 5, 3))
    for i in range(5):
        start = [strength] * 3, [strength * x for x in theta[i]]
        assert pulled[i].tolist() == naive_ucb1(payoffs[i], *start, uniform[:, i])


def test_beliefs_of_thompson_sampling_by_hand():
    many = Arms(np.full((40_000, 1), 6.0), np.full((40_000, 1), 4.0))
    # Beta(5, 3): mean 5/8, variance 15/576. Five standard errors of the mean are 0.004.
    draws = beta_thompson(many, random())
    assert draws.mean() == pytest.approx(5 / 8, abs=0.005)
    assert draws.var() == pytest.approx(15 / 576, rel=0.05)


def test_regret_by_hand():
    lost = regret(np.array([[1, 0, 2]]), np.array([[0.5, 0.2, 0.9]]))
    np.testing.assert_allclose(lost, [[0.7, 1.1, 1.1]])


def test_each_broken_rule_is_one_clear_line():
    for call, words in (
        (lambda: flat_arms(0, 2), "n_problems and n_arms must be at least 1"),
        (lambda: prior_arms([0.5, 0.5], 1), "theta must be"),
        (lambda: prior_arms([[1.5, 0.5]], 1), "theta must be"),
        (lambda: prior_arms([[0.5, 0.5]], -1), "strength must be finite and at least 0"),
        (lambda: play(ucb1, flat_arms(2, 2), np.zeros((2, 5, 3)), random()), "payoffs must be"),
    ):
        with pytest.raises(InputError, match=words):
            call()
