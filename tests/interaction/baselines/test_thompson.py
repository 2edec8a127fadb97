import numpy as np
import pytest

from lifelore.interaction.baselines import GaussianThompson


def test_the_belief_by_hand():
    player = GaussianThompson(2, prior_means=[1.0, 0.0], prior_deviations=2.0, noise=1.0)
    player.update(0, 3.0)
    player.update(0, 5.0)
    # Precision 1/4 + 2 = 2.25; mean (0.25 · 1 + 2 · 4) / 2.25 = 3.6667; deviation 1/1.5.
    mean, deviation = player.beliefs()
    assert mean[0] == pytest.approx([3.6667, 0.0], abs=1e-4)
    assert deviation[0] == pytest.approx([2 / 3, 2.0])


def test_policies_are_played_as_often_as_they_are_thought_best():
    player = GaussianThompson(2, prior_means=[0.0, 1.0], prior_deviations=[1.0, 1.0], n_tasks=20_000, seed=0)
    # P(N(1, 1) > N(0, 1)) = Φ(1/√2) = 0.7602; five deviations of the share are 0.0151.
    assert player.select().mean() == pytest.approx(0.7602, abs=0.0151)


def test_from_library_knows_spread_between_types_and_noise_within(library):
    player = GaussianThompson.from_library(library)
    mean, deviation = player.beliefs()
    assert mean[0] == pytest.approx([0.75, 0.35, 0.45, 0.025])
    assert deviation[0] == pytest.approx(np.sqrt(0.1875) * np.array([1, 0.6, 0.2, 0.1]))
    player.update(0, 0.75)
    assert player.beliefs()[1][0][0] == pytest.approx((1 / 0.1875 + 1 / 0.01) ** -0.5)
