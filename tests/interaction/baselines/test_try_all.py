import numpy as np
import pytest

from lifelore.interaction.baselines import TryAll


@pytest.mark.parametrize("rounds", [1, 3])
def test_each_policy_as_often_as_told_and_then_the_best(rounds):
    means = np.array([[0.1, 0.9, 0.3], [0.7, 0.2, 0.5]])
    player = TryAll(3, rounds=rounds, n_tasks=2, seed=1)
    chosen = []
    for _ in range(3 * rounds + 4):
        policy = player.select()
        player.update(policy, means[[0, 1], policy])
        chosen.append(policy)
    tried, after = np.array(chosen[: 3 * rounds]), np.array(chosen[3 * rounds :])
    for row in range(2):
        assert np.bincount(tried[:, row]).tolist() == [rounds] * 3
        assert all(len(set(part)) == 3 for part in tried[:, row].reshape(rounds, 3))
    assert (after == [1, 0]).all()


def test_the_order_is_drawn_for_each_task():
    first = TryAll(6, n_tasks=200, seed=0).select()
    assert set(first) == set(range(6))
