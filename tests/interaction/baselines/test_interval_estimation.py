import numpy as np
import pytest
from scipy import stats

from lifelore.interaction.baselines import IntervalEstimation


def test_the_limit_is_the_one_sided_interval_of_scipy():
    seen = np.random.default_rng(0).normal(5, 2, 12)
    player = IntervalEstimation(1, alpha=0.1)
    for paid in seen:
        player.update(0, paid)
    _, high = stats.t.interval(0.8, df=11, loc=seen.mean(), scale=stats.sem(seen))
    assert player._scores()[0][0] == pytest.approx(high)


def test_each_policy_is_played_twice_first():
    player = IntervalEstimation(3, seed=2)
    chosen = []
    for turn in range(6):
        chosen.append(player.select())
        player.update(chosen[-1], float(turn))
    assert np.bincount(chosen).tolist() == [2, 2, 2]


def test_a_prior_stands_for_plays(library):
    player = IntervalEstimation.from_library(library, quantile="normal", prior_pulls=4)
    mean, spread = np.array([0.75, 0.35, 0.45, 0.025]), np.sqrt(0.1875) * np.array([1, 0.6, 0.2, 0.1])
    deviation = np.sqrt(spread**2 + 0.01)
    assert player._scores()[0] == pytest.approx(mean + stats.norm.ppf(0.95) * deviation / 2)
    player.update(0, 0.75)
    # The mean stays, Σ (x - m)² stays at 3 s², n = 5.
    expected = 0.75 + stats.norm.ppf(0.95) * deviation[0] * np.sqrt(3 / 4) / np.sqrt(5)
    assert player._scores()[0][0] == pytest.approx(expected)
