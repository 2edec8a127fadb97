"""The offline procedure of §4.4.1: every policy on every instance of every type."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.interaction.library.offline_runs import run_offline
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.signals.reward_signal import RewardSignal


def noisy(policy, task, generator):
    rewards = generator.normal(policy * task, 0.1, 3)
    return float(rewards.sum()), rewards


def instances(type_, generator):
    return [type_ + generator.normal(0, 0.01) for _ in range(int(type_) + 3)]


def test_every_policy_runs_on_every_instance_and_the_library_is_fitted():
    runs = run_offline([0, 1, 2], [1.0, -1.0], instances, noisy, seed=3, repeats=2)
    assert runs.outcomes.shape == (3, 2, 10)
    assert (~np.isnan(runs.outcomes)).sum(axis=2).tolist() == [[6, 6], [8, 8], [10, 10]]
    library = PolicyLibrary.from_samples(runs.outcomes)
    np.testing.assert_allclose(library.performance.mean, 3 * np.array([[0, 0], [1, -1], [2, -2]]), atol=0.4)
    rewards = RewardSignal.from_sequences(runs.sequences(), 3, 2, model="gaussian")
    np.testing.assert_allclose(rewards.rewards.mean, np.array([[0, 0], [1, -1], [2, -2]]), atol=0.15)


def test_a_policy_more_moves_no_other_run():
    fewer = run_offline([1, 2], [1.0], instances, noisy)
    more = run_offline([1, 2], [1.0, 5.0], instances, noisy)
    np.testing.assert_array_equal(fewer.outcomes[:, 0], more.outcomes[:, 0])


def test_bad_input_is_refused():
    with pytest.raises(InputError, match="must be at least 1"):
        run_offline([], [1], instances, noisy)
    with pytest.raises(InputError, match="type 0 has no instance"):
        run_offline([1], [1], lambda type_, generator: [], noisy)
    with pytest.raises(InputError, match="utility of policy 0 on type 0 is nan"):
        run_offline([1], [1], instances, lambda *_: float("nan"))
