"""What models take to store, by hand and in a tiny run."""

import numpy as np
import pytest

from lifelore.interaction.library.storage_cost import StorageSizes
from reproduction.chapter4.c4_09_model_storage.applications import (
    Application,
    pacman_application,
    random_application,
    reserve_application,
    telephone_application,
    with_returns,
)
from reproduction.chapter4.c4_09_model_storage.measure import measure
from reproduction.chapter4.c4_09_model_storage.stored_models import array_bytes, stored
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.9")

TINY = {
    "states": [3, 8], "rewards": [2, 12], "draws": 2, "episodes": 5, "models": [3], "reserves": [[17, 5]],
    "mazes": [[5, 3]], "samples": 2,
}  # fmt: skip


@pytest.fixture(scope="module")
def tiny():
    settings = CLAIM.settings("quick", TINY)
    return settings, [CLAIM.run_cell(settings, cell, 0) for cell in CLAIM.cells(settings)]


def by_hand():
    """One type, one policy, two states, one action, rewards 0, 1, 2; two episodes of two steps."""
    there, back = (0, 0, 1), (1, 0, 0)
    episodes = [(np.array([there, back]), np.array([1.0, 0.0])), (np.array([there, there]), np.array([1.0, 2.0]))]
    return Application(StorageSizes(1, 1, 2, 1, 3), np.arange(3.0), with_returns([[episodes]]))


def test_entries_by_hand():
    found = stored(by_hand())
    assert found["table"] == {"performance": 3, "reward": 2 * 1 * 3, "state-action-state": 2 * 2 * 1}
    # Returns 1 and 3; (0, 0) paid 1 and 2, (1, 0) paid 0; there and back.
    assert found["filled"] == {"performance": 2, "reward": 3, "state-action-state": 2}
    assert len(found["built"]) == 3


def test_bytes_are_those_of_the_arrays_whatever_numbers_they_hold():
    # Performance: 3 counts, 4 borders and the pseudo-count of 8 bytes, and a flag of 1. Rewards: 6 logarithms,
    # 2 totals, 2 places and 3 rewards. Transitions: 4 logarithms, 2 totals and 2 places.
    size = {"performance": 8 * 8 + 1, "reward": 8 * 13, "state-action-state": 8 * 8}
    assert stored(by_hand())["bytes"] == size

    # A compressed file is longer where the numbers are less alike.
    class Noise:
        def to_arrays(self):
            return {"a": np.random.default_rng(0).normal(size=100)}

    class Zeros:
        def to_arrays(self):
            return {"a": np.zeros(100)}

    assert array_bytes(Noise()) == array_bytes(Zeros()) == 800


def test_rewards_that_are_a_function_of_the_step_fill_no_more_than_the_steps():
    settings = {"types": 2, "policies": 2, "actions": 2, "episodes": 8, "horizon": 12}
    for seed in range(5):
        found = stored(random_application(np.random.default_rng(seed), 4, 50, "transition", settings))
        assert found["filled"]["reward"] <= found["filled"]["state-action-state"]
    noisy = stored(random_application(np.random.default_rng(0), 4, 50, "noise", settings))
    assert noisy["filled"]["reward"] > noisy["filled"]["state-action-state"]


def test_telephone_has_as_many_rewards_as_states():
    found = telephone_application(np.random.default_rng(0), 3, 4)
    assert (found.sizes.n_states, found.sizes.n_rewards, found.sizes.n_actions) == (6, 6, 1)
    assert all(pay.sum() in (3.0, 10.0) for _, _, (_, pay) in found.runs.sequences())


def test_reserve_has_more_or_fewer_rewards_than_states_by_how_pay_is_rounded():
    fine, coarse = (reserve_application(np.random.default_rng(0), 17, step, 3) for step in (1, 50))
    assert fine.sizes.n_rewards > fine.sizes.n_states == 18 > coarse.sizes.n_rewards
    assert stored(fine)["table"]["reward"] == 17 * 17 * 18 * fine.sizes.n_rewards


def test_pacman_is_too_large_for_its_table_and_too_small_to_fill_it():
    found = stored(pacman_application(np.random.default_rng(0), 5, 3, 2))
    assert "state-action-state" not in found["built"]
    assert found["table"]["state-action-state"] == 16 * 2912**2 * 4
    assert found["filled"]["state-action-state"] < 16 * 2 * 200
    assert found["bytes"]["state-action-state"] is None


def test_measures_by_hand():
    def one(rewards, performance, reward, states):
        entries = {"performance": performance, "reward": reward, "state-action-state": states}
        return {"states": 4, "rewards": rewards, "actions": 2, "pairs": 1, "table": entries, "filled": entries,
                "bytes": entries, "built": list(entries)}  # fmt: skip

    # |S|² |A| = 32; with 8 rewards |S| |A| |R| = 64, with 2 rewards 16.
    results = [
        {"cell": {"kind": "random", "rewards_of": "noise"}, "stored": [one(8, 8, 64, 32), one(40, 40, 320, 32)]},
        {"cell": {"kind": "random", "rewards_of": "noise"}, "stored": [one(2, 2, 16, 32), one(4, 4, 32, 33)]},
    ]
    measured = {name: found.value for name, found in measure({"rewards_of": ["noise"]}, results).items()}
    assert measured["performance_below_transition_more_rewards_than_states"] == 0.5
    assert measured["reward_below_transition_more_rewards_than_states"] == 0
    assert measured["performance_below_reward_more_rewards_than_states"] == 1
    assert measured["printed_order_fewer_rewards_than_states"] == 1
    # The last table has an entry too many, and |R| = |S| is on neither side.
    assert measured["right_formulas_equal_tables"] == 0.75
    assert measured["printed_formulas_bound_tables"] == 0


def test_tables_are_as_the_right_formulas_say(tiny):
    settings, results = tiny
    measured = CLAIM.measure(settings, results)
    assert measured["right_formulas_equal_tables"].value == 1
    assert measured["reward_below_transition_more_rewards_than_states"].value == 0
    assert measured["printed_order_fewer_rewards_than_states"].value == 1


def test_tiny_run_draws_its_figure(tiny):
    settings, results = tiny
    figure = CLAIM.draw({"rows": CLAIM.rows(settings, results)})
    assert len(figure.axes) == 3
