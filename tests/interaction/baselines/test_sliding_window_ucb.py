"""Sliding-window UCB: what leaves the window, the naive twin, a change that UCB1 follows late."""

from math import log, sqrt

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.baselines import UCB1, SlidingWindowUCB


def test_bounds_by_hand():
    player = SlidingWindowUCB(2, window=3)
    for policy, paid in ((0, 1.0), (0, 0.0), (1, 0.5), (1, 0.25)):
        player.update(policy, paid)
    # The first play has left: policy 0 paid 0 once, policy 1 0.375 in two; min(t, τ) = 3, ξ = 0.6.
    assert player._scores()[0] == pytest.approx([sqrt(0.6 * log(3)), 0.375 + sqrt(0.6 * log(3) / 2)])


def test_a_naive_window_chooses_the_same():
    random = np.random.default_rng(3)
    paid, prior = random.random((150, 4)), [0.4, 0.5, 0.6, 0.3]
    player = SlidingWindowUCB(4, window=20, exploration=0.5, scale=(-1, 3), prior_means=prior, prior_pulls=0.5)
    history = []
    for row in paid:
        last = history[-20:]
        bounds = []
        for policy in range(4):
            own = [(value + 1) / 4 for played, value in last if played == policy]
            n = 0.5 + len(own)
            mean = (0.5 * (prior[policy] + 1) / 4 + sum(own)) / n
            bounds.append(mean + 0.5 * sqrt(2 * log(max(4 * 0.5 + len(last), 1)) / n))
        assert player._scores()[0] == pytest.approx(bounds, rel=1e-9)
        policy = player.select()
        assert policy == bounds.index(max(bounds))
        history.append((policy, float(row[policy])))
        player.update(*history[-1])


def test_an_endless_window_is_ucb1():
    random = np.random.default_rng(8)
    paid = random.random((100, 3, 4))
    players = [
        UCB1(4, n_tasks=3, seed=np.random.default_rng(1), exploration=0.3),
        SlidingWindowUCB(4, n_tasks=3, seed=np.random.default_rng(1), exploration=0.3, window=100),
    ]
    for row in paid:
        chosen = [player.select() for player in players]
        assert np.array_equal(*chosen)
        for player in players:
            player.update(chosen[0], row[np.arange(3), chosen[0]])


def test_a_policy_without_a_play_in_the_window_is_played_again():
    player = SlidingWindowUCB(3, window=4, exploration=0)
    for paid in (0.2, 0.9, 0.1, 0.9, 0.9, 0.9):
        player.update({0.2: 0, 0.9: 1, 0.1: 2}[paid], paid)
    assert player._scores()[0].tolist() == pytest.approx([np.inf, 0.9, 0.1])
    assert player.select() == 0


def test_a_change_of_the_best_policy_is_followed_sooner_than_by_ucb1():
    plays = {}
    for player in (
        UCB1(2, n_tasks=50, exploration=0.1),
        SlidingWindowUCB(2, n_tasks=50, exploration=0.1, window=50),
    ):
        random, kind = np.random.default_rng(9), type(player)
        for number in range(400):
            policy = player.select()
            best = 0 if number < 300 else 1
            player.update(policy, np.where(policy == best, 0.8, 0.2) + random.normal(0, 0.1, 50))
            if number >= 350:
                plays[kind] = plays.get(kind, 0) + (policy == 1).mean() / 50
    # Policy 1 has one play of 0.2, with a bonus of 0.34: UCB1 needs 228 plays of 0.2 beside 300 of 0.8 to try it.
    assert plays[SlidingWindowUCB] > 0.8
    assert plays[UCB1] < 0.2


def test_the_window_of_a_horizon():
    # 2 √(200 ln 200 / 3) = 37.6
    assert SlidingWindowUCB(2, horizon=200, changes=3).window == 38
    assert SlidingWindowUCB(2, horizon=1).window == 1
    assert SlidingWindowUCB(2).window == 100


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"window": 3, "horizon": 4}, "give either window or horizon"),
        ({"window": 0}, "window must be at least 1, got 0"),
        ({"horizon": 0}, "horizon must be at least 1, got 0"),
        ({"changes": 0}, "changes must be at least 1, got 0"),
    ],
)
def test_bad_settings(settings, said):
    with pytest.raises(InputError, match=said):
        SlidingWindowUCB(2, **settings)
