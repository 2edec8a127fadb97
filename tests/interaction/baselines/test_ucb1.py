import numpy as np
import pytest

from lifelore.interaction.baselines import UCB1


def test_prior_means_count_as_pulls():
    player = UCB1(2, prior_means=[0.2, 0.6], prior_pulls=2)
    # t = 4: both bounds are √(2 ln 4 / 2) above the means.
    assert player._scores()[0] == pytest.approx(np.array([0.2, 0.6]) + np.sqrt(np.log(4)))
    player.update(1, 0.0)
    # 0.6 · 2 / 3 = 0.4, t = 5.
    assert player._scores()[0] == pytest.approx([0.2 + np.sqrt(np.log(5)), 0.4 + np.sqrt(2 * np.log(5) / 3)])


def test_scale_maps_payoffs_and_prior():
    player = UCB1(2, exploration=0, scale=(-100, 300), prior_means=[100, 0])
    assert player._scores()[0] == pytest.approx([0.5, 0.25])
    player.update(0, 300)
    assert player._scores()[0] == pytest.approx([0.75, 0.25])


def test_a_naive_ucb1_chooses_the_same():
    generator = np.random.default_rng(3)
    payoffs = generator.random((80, 4))
    player = UCB1(4, exploration=0.7, prior_means=[0.4, 0.5, 0.6, 0.3], seed=0)
    sums, counts = [0.4, 0.5, 0.6, 0.3], [1, 1, 1, 1]
    for paid in payoffs:
        t = sum(counts)
        bounds = [s / n + 0.7 * (2 * np.log(t) / n) ** 0.5 for s, n in zip(sums, counts, strict=True)]
        best = bounds.index(max(bounds))
        assert player.select() == best
        player.update(best, paid[best])
        sums[best] += paid[best]
        counts[best] += 1


def test_from_library_has_means_under_the_prior_on_a_scale_as_wide_as_the_deviation(library):
    player = UCB1.from_library(library, exploration=0)
    # 0.75 (1, .2, .4, 0) + 0.25 (0, .8, .6, .1), their mean 0.39375. Deviations between types are √(0.75 · 0.25)
    # of the differences (1, .6, .2, .1): 0.433, 0.260, and two below the noise of 0.1, which is then the larger.
    means = np.array([0.75, 0.35, 0.45, 0.025])
    width = np.sqrt((0.1875 * (1 + 0.36) + 0.01 + 0.01) / 4)
    assert player._scores()[0] == pytest.approx((means - 0.39375) / width + 0.5)
    assert UCB1.from_library(library, prior_means=None)._scores()[0].tolist() == [np.inf] * 4
