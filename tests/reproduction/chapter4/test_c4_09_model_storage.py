"""What models take to store, by hand, and what the formulas of §4.7.6 assume."""

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from reproduction.chapter4.c4_09_model_storage.run import StorageSizes, entries_of, measure, run_cell

COUNT = st.integers(1, 50)


def test_tables_are_as_the_right_formulas_say_and_the_printed_ones_are_swapped():
    settings = {"types": 2, "policies": 3, "actions": 2, "episodes": 4, "horizon": 5}
    found = run_cell(settings, {"states": 3, "rewards": 7}, 0)
    assert found["table"] == found["right"]
    assert found["printed"]["reward"] == found["table"]["state_action_state"] == 6 * 9 * 2
    assert found["printed"]["state_action_state"] == found["table"]["reward"] == 6 * 3 * 2 * 7


def test_measures_by_hand():
    def one(rewards, *sizes):
        table = dict(zip(("performance", "reward", "state_action_state"), sizes, strict=True))
        printed = {**table, "reward": sizes[2], "state_action_state": sizes[1]}
        return {"states": 4, "rewards": rewards, "table": table, "right": table, "printed": printed}

    # |S|² |A| = 32; with 8 rewards |S| |A| |R| = 64, with 2 rewards 16.
    values = {name: n.value for name, n in measure({}, [one(8, 8, 64, 32), one(2, 2, 16, 32)]).items()}
    assert values == {
        "performance_below_reward": 1, "reward_below_transition": 0, "printed_formulas_bound": 4 / 6,
        "right_formulas": 1,
    }  # fmt: skip


@given(COUNT, COUNT, COUNT)
def test_the_printed_order_holds_where_there_are_fewer_rewards_than_states(n_states, n_rewards, n_actions):
    performance, reward, state = entries_of(StorageSizes(1, 1, n_states, n_actions, n_rewards)).values()
    assert performance <= reward
    assert (reward < state) == (n_rewards < n_states)


@pytest.mark.parametrize(("rewards", "horizon"), [((0.0, 1.0), 3), ((0.0, 1.0, 10.0), 2), ((0.0, 1.0, 7.3), 3)])
def test_returns_take_more_values_than_the_printed_bound(rewards, horizon):
    """|R| values for an average, (1 - γ^T) / (1 - γ) |R| for a discounted sum: sums of rewards take more."""
    gamma = 0.37
    drawn = list(itertools.product(rewards, repeat=horizon))
    sums = {round(sum(of), 9) for of in drawn}
    discounted = {round(sum(gamma**i * reward for i, reward in enumerate(of)), 9) for of in drawn}
    assert len(sums) > len(rewards)
    assert len(discounted) > (1 - gamma**horizon) / (1 - gamma) * len(rewards)
