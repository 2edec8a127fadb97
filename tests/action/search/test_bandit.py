"""Bandits by hand and against a plain twin, one problem at a time."""

import math

import numpy as np
import pytest

from lifelore.action.search.bandit import (
    Arms,
    beta_thompson,
    flat_arms,
    play,
    prior_arms,
    regret,
    ucb1,
)
from lifelore.core.errors import InputError


def random():
    return np.random.default_rng(0)


def test_ucb1_by_hand():
    arms = Arms(np.array([[4.0, 1.0, 0.0]]), np.array([[3.0, 0.0, 0.0]]))
    bounds = ucb1(arms, random())[0]
    assert bounds[0] == pytest.approx(3 / 4 + math.sqrt(2 * math.log(5) / 4))
    assert bounds[1] == pytest.approx(math.sqrt(2 * math.log(5)))
    assert bounds[2] == np.inf


def test_pseudo_counts_by_hand():
    arms = prior_arms([[0.75, 0.25], [0.5, 0.5]], strength=2, useful=0.8, useless=0.2)
    np.testing.assert_allclose(arms.pulls, 2)
    np.testing.assert_allclose(arms.paid, [[1.3, 0.7], [1.0, 1.0]])
    nothing = prior_arms([[0.75, 0.25]], strength=0)
    assert (nothing.pulls == flat_arms(1, 2).pulls).all()
    assert (nothing.paid == 0).all()


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


def test_play_leaves_its_start_as_it_is():
    arms = prior_arms([[0.6, 0.4]], 3)
    play(beta_thompson, arms, np.ones((1, 5, 2)), random())
    assert arms.pulls.tolist() == [[3, 3]]
    assert arms.paid.tolist() == [[pytest.approx(1.8), pytest.approx(1.2)]]


def test_beliefs_of_thompson_sampling_by_hand():
    many = Arms(np.full((40_000, 1), 6.0), np.full((40_000, 1), 4.0))
    # Beta(5, 3): mean 5/8, variance 15/576. Five standard errors of the mean are 0.004.
    draws = beta_thompson(many, random())
    assert draws.mean() == pytest.approx(5 / 8, abs=0.005)
    assert draws.var() == pytest.approx(15 / 576, rel=0.05)


@pytest.mark.parametrize("index", [ucb1, beta_thompson])
def test_a_right_prior_regrets_less_than_none_and_a_wrong_one_more(index):
    means = np.tile([0.8, 0.2, 0.2, 0.2], (200, 1))
    payoffs = (random().random((200, 100, 4)) < means[:, None]).astype(float)

    def lost(arms):
        return regret(play(index, arms, payoffs, random()), means)[:, -1].mean()

    right, wrong = ([np.roll([0.7, 0.1, 0.1, 0.1], shift)] * 200 for shift in (0, 1))
    assert lost(prior_arms(right, 4)) < 0.7 * lost(flat_arms(200, 4))
    assert lost(prior_arms(wrong, 16)) > lost(prior_arms(right, 16))
    # The best arm is found all the same: over the last 50 pulls another is pulled in less than a third.
    late = regret(play(index, prior_arms(wrong, 4), payoffs, random()), means)
    assert (late[:, -1] - late[:, -51]).mean() < 50 * 0.6 / 3


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
