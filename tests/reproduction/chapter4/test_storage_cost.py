"""Storage by §4.7.6: the formulas swapped in print, the orders, and what they assume."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lifelore.core.errors import InputError
from lifelore.interaction.signals.step_reward_signal import StepRewardSignal
from lifelore.interaction.signals.transition_signal import TransitionSignal
from reproduction.chapter4.c4_09_model_storage.storage_cost import (
    StorageSizes,
    effective_horizon,
    n_returns,
    storage_cost,
)

COUNT = st.integers(1, 50)


def sizes(n_states, n_rewards, n_actions=3):
    return StorageSizes(5, 2, n_states, n_actions, n_rewards, bits=64)


def test_formulas_by_hand():
    right = storage_cost(sizes(10, 4))
    assert right.performance == 5 * 2 * 4 * 64
    assert right.reward == 5 * 2 * 4 * 10 * 3 * 64
    assert right.state_action_state == 5 * 2 * 10 * 10 * 3 * 64
    printed = storage_cost(sizes(10, 4), "thesis")
    assert (printed.reward, printed.state_action_state) == (right.state_action_state, right.reward)
    assert printed.performance == right.performance


@pytest.mark.parametrize("n_rewards", [3, 12])
def test_printed_formulas_are_swapped(n_rewards):
    """What the two models really store, entry by entry, is what the formulas say once they have changed places."""
    n_states, n_actions, n_types, n_policies = 4, 2, 3, 5
    transitions = TransitionSignal(np.full((n_types, n_policies, n_states, n_actions, n_states), 1 / n_states))
    rewards = StepRewardSignal(
        range(n_rewards), np.full((n_types, n_policies, n_states, n_actions, n_rewards), 1 / n_rewards)
    )
    sizes = StorageSizes(n_policies, n_types, n_states, n_actions, n_rewards, bits=1)
    right, printed = storage_cost(sizes), storage_cost(sizes, "thesis")
    assert (transitions.n_entries, rewards.n_entries) == (right.state_action_state, right.reward)
    assert (transitions.n_entries, rewards.n_entries) == (printed.reward, printed.state_action_state)
    assert transitions.n_entries != printed.state_action_state


@given(COUNT, COUNT, COUNT)
def test_the_printed_order_holds_where_there_are_fewer_rewards_than_states(n_states, n_rewards, n_actions):
    right = storage_cost(StorageSizes(1, 1, n_states, n_actions, n_rewards))
    assert right.performance <= right.reward
    assert (right.reward < right.state_action_state) == (n_rewards < n_states)


def test_the_printed_order_is_not_right_where_it_is_claimed():
    """R > S: performance < state-action-state < reward; with very many rewards performance is no longer least."""
    assert storage_cost(sizes(10, 20)).order() == ("performance", "state-action-state", "reward")
    assert storage_cost(sizes(10, 20), "thesis").order() == ("performance", "reward", "state-action-state")
    assert storage_cost(sizes(10, 1000)).order() == ("state-action-state", "performance", "reward")
    assert storage_cost(sizes(10, 1000), "thesis").order()[0] == "reward"


def test_discounted_performance():
    assert effective_horizon(3, 0.5) == 1.75
    assert effective_horizon(3, 1.0) == 3
    assert effective_horizon(200, 0.0) == 1
    cost = storage_cost(StorageSizes(1, 1, 1, 1, 4, horizon=3, discount=0.5, bits=1))
    assert cost.discounted_performance == 7


@pytest.mark.parametrize(("rewards", "horizon"), [((0.0, 1.0), 3), ((0.0, 1.0, 10.0), 2), ((0.0, 1.0, 7.3), 3)])
def test_returns_take_more_values_than_the_printed_bound(rewards, horizon):
    """|R| values for an average, (1 - γ^T) / (1 - γ) |R| for a discounted sum: sums of rewards take more."""
    gamma = 0.37
    sums = {round(sum(drawn), 9) for drawn in itertools.product(rewards, repeat=horizon)}
    discounted = {
        round(sum(gamma**i * reward for i, reward in enumerate(drawn)), 9)
        for drawn in itertools.product(rewards, repeat=horizon)
    }
    assert len(sums) > len(rewards)
    assert len(discounted) > effective_horizon(horizon, gamma) * len(rewards)
    assert len(sums) <= n_returns(len(rewards), horizon, discounted=False)
    assert len(discounted) <= n_returns(len(rewards), horizon, discounted=True)


def test_counts_of_returns_by_hand():
    assert n_returns(2, 3, discounted=False) == 4
    assert n_returns(2, 3, discounted=True) == 8
    assert n_returns(1, 100, discounted=False) == 1
    assert n_returns(10, 10_000, discounted=True) == np.inf
    assert n_returns(1000, 1000, discounted=False) == np.inf
    with pytest.raises(InputError, match="n_rewards must be a whole number"):
        n_returns(0, 3, discounted=False)


def test_numpys_whole_numbers_are_as_good_and_never_wrap_around():
    sizes_ = [10**6, 10**6, 10**6, 10**6, 10**6]
    assert storage_cost(StorageSizes(*map(np.int64, sizes_))) == storage_cost(StorageSizes(*sizes_))
    assert storage_cost(StorageSizes(*map(np.int64, sizes_))).reward == 64 * 10**30


@pytest.mark.parametrize("bad", [{"n_states": 0}, {"n_rewards": 2.5}, {"discount": 1.5}, {"bits": -1}])
def test_bad_sizes_are_refused(bad):
    with pytest.raises(InputError, match=next(iter(bad))):
        StorageSizes(**({"n_policies": 1, "n_types": 1, "n_states": 1, "n_actions": 1, "n_rewards": 1} | bad))
    with pytest.raises(InputError, match="variant"):
        storage_cost(sizes(1, 1), "printed")
