import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.interaction.baselines.arm_statistics import ArmStatistics

payoffs = st.lists(st.floats(-1e3, 1e3), min_size=2, max_size=20)


@pytest.mark.slow
@settings(deadline=None)
@given(payoffs, payoffs)
def test_one_at_a_time_gives_the_mean_and_deviation_of_all(first, second):
    arms = ArmStatistics.empty(2, 3)
    for left, right in zip(first, second, strict=False):
        arms.add(np.array([0, 2]), np.array([left, right]))
    n = min(len(first), len(second))
    assert arms.pulls.tolist() == [[n, 0, 0], [0, 0, n]]
    assert arms.mean[0, 0] == pytest.approx(np.mean(first[:n]), abs=1e-9)
    assert np.sqrt(arms.squares[1, 2] / (n - 1)) == pytest.approx(np.std(second[:n], ddof=1), abs=1e-6)
    assert arms.squares[0, 1] == 0


def test_a_prior_is_as_if_it_had_been_seen():
    seen = np.array([1.0, 2.0, 6.0])
    prior = ArmStatistics.from_prior(1, 1, [3.0], 3, [seen.std(ddof=1)])
    prior.add(np.array([0]), np.array([4.0]))
    assert prior.mean[0, 0] == pytest.approx(13 / 4)
    assert np.sqrt(prior.squares[0, 0] / 3) == pytest.approx(np.std([1, 2, 6, 4], ddof=1))


def test_what_is_removed_was_never_there():
    random = np.random.default_rng(6)
    policies, paid = random.integers(3, size=(50, 2)), random.normal(1e3, 1, (50, 2))
    arms, rest = ArmStatistics.empty(2, 3), ArmStatistics.empty(2, 3)
    for number in range(50):
        arms.add(policies[number], paid[number])
        if number >= 20:
            arms.remove(policies[number - 20], paid[number - 20])
    for number in range(30, 50):
        rest.add(policies[number], paid[number])
    assert arms.pulls.tolist() == rest.pulls.tolist()
    assert arms.mean == pytest.approx(rest.mean, rel=1e-12)
    assert arms.squares == pytest.approx(rest.squares, abs=1e-6)
    arms = ArmStatistics.empty(1, 1)
    arms.add(np.array([0]), np.array([0.3]))
    arms.remove(np.array([0]), np.array([0.3]))
    assert (arms.pulls.item(), arms.mean.item(), arms.squares.item()) == (0, 0, 0)
