"""Sliding-window UCB: what leaves the window, the naive twin, a change that UCB1 follows late."""

from math import log, sqrt

import numpy as np
import pytest

from lifelore.interaction.baselines import SlidingWindowUCB


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
