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


@pytest.mark.parametrize("bad", [{"n_states": 0}, {"n_rewards": 2.5}, {"discount": 1.5}, {"bits": -1}])
def test_bad_sizes_are_refused(bad):
    with pytest.raises(InputError, match=next(iter(bad))):
        StorageSizes(**({"n_policies": 1, "n_types": 1, "n_states": 1, "n_actions": 1, "n_rewards": 1} | bad))
    with pytest.raises(InputError, match="variant"):
        storage_cost(sizes(1, 1), "printed")
