import numpy as np
import pytest

from lifelore.interaction.baselines.arm_statistics import ArmStatistics


def test_a_prior_is_as_if_it_had_been_seen():
    seen = np.array([1.0, 2.0, 6.0])
    prior = ArmStatistics.from_prior(1, 1, [3.0], 3, [seen.std(ddof=1)])
    prior.add(np.array([0]), np.array([4.0]))
    assert prior.mean[0, 0] == pytest.approx(13 / 4)
    assert np.sqrt(prior.squares[0, 0] / 3) == pytest.approx(np.std([1, 2, 6, 4], ddof=1))
