"""What models take to store, by hand."""

from reproduction.chapter4.c4_09_model_storage.run import measure, run_cell


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
