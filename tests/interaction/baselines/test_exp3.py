import numpy as np
import pytest

from lifelore.interaction.baselines import EXP3


def test_gamma_of_a_horizon_by_hand():
    # √(2 ln 2 / (1.71828 · 100)) = 0.08982.
    assert EXP3(2, horizon=100).gamma == pytest.approx(0.08982, abs=1e-5)
    assert EXP3(50, horizon=1).gamma == 1.0


def test_two_updates_by_hand():
    player = EXP3(3, gamma=0.3)
    player.update(1, 0.5)
    # p = 1/3: w₁ = exp(0.3 · 1.5 / 3) = exp(0.15).
    first = 0.7 * np.exp(0.15) / (np.exp(0.15) + 2) + 0.1
    assert player.probabilities[1] == pytest.approx(first)
    player.update(1, 1.0)
    weight = np.exp(0.15 + 0.3 / first / 3)
    assert player.probabilities == pytest.approx(
        [0.7 / (weight + 2) + 0.1, 0.7 * weight / (weight + 2) + 0.1, 0.7 / (weight + 2) + 0.1]
    )


def test_what_lies_outside_the_scale_is_clipped():
    high, one = EXP3(2, gamma=0.2, scale=(0, 10)), EXP3(2, gamma=0.2, scale=(0, 10))
    high.update(0, 1e9)
    one.update(0, 10.0)
    assert np.array_equal(high.probabilities, one.probabilities)


def test_payoffs_of_0_say_nothing():
    """What §4.8.5 gives it: a pull a step, and a payoff at the goal alone. Until then it plays at random."""
    player = EXP3(5, gamma=0.1)
    for step in range(140):
        player.update(step % 5, 0.0)
    assert player.probabilities == pytest.approx(0.2)
