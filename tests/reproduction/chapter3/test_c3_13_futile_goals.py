"""Measures of C3.13 from made-up cells, by hand."""

import pytest

from lifelore.core.errors import InputError
from reproduction.chapter3.c3_13_futile_goals.measure import measure, rows, slope
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.13")
QUICK = dict(claim_of("C3.13").sizes["quick"])

SETTINGS = {
    **QUICK, "runs": 3, "draws": 1000, "actions": [2], "alpha0": [1.0], "tasks": [0, 1, 10], "alike": [2],
    "kinds": ["random"], "found_tasks": [1], "default": {"actions": 2, "alpha0": 1.0},
}  # fmt: skip
# Eq. 3.6 for two actions and α⁰ 1: 1/2, 1/3 and 1/12; of two states alike 1/2, 1/4 and 1/22.
STATES, PERCEPTS = {0: 1 / 2, 1: 1 / 3, 10: 1 / 12}, {0: 1 / 2, 1: 1 / 4, 10: 1 / 22}


def made_up(scale=1.0, below=0):
    """Three runs in which `scale` times what is expected was taken, a bit apart by run."""
    cells = []
    for run in range(3):
        cases = []
        for alike, formulas in ((1, STATES), (2, PERCEPTS)):
            for tasks, formula in formulas.items():
                taken = round(1000 * formula * scale * (1 + 0.01 * (run - 1)))
                case = {"actions": 2, "alike": alike, "alpha0": 1.0, "tasks": tasks, "formula": formula}
                case |= {"prior": formula, "taken": taken}
                if alike == 1:
                    case |= {"taken_uniform_ties": 500, "taken_prior_ties": taken}
                cases.append(case)
        world = {"kind": "random", "tasks": 1, "entering": 4, "below_states": below, "below_percepts": 1}
        world |= {"below_percepts_pooled": 0, "bound": 0.25, "least": 0.5, "least_percepts": 0.2 - 0.01 * run}
        cells.append({"run": run, "constructed": cases, "found": [{**world, "expected": 0.5, "taken": 499 + run}]})
    return cells


def plain(measured):
    return {name: number.to_dict() for name, number in measured.items()}


def test_slopes_by_hand():
    assert slope([1, 10, 100], [1.0, 0.1, 0.01]) == pytest.approx(-1)
    assert slope([1, 4], [0.5, 0.25]) == pytest.approx(-0.5)


def test_numbers_by_hand():
    found = measure(SETTINGS, made_up())
    assert found["prior_error_states"].value == 0
    assert found["frequency_ratio_states"].value == pytest.approx(1, abs=0.01)
    assert found["frequency_ratio_no_task"].value == pytest.approx(1, abs=0.01)
    # 1/3 to 1/12 over a decade: the logarithm of 4 over that of 10.
    assert found["slope_default"].value == pytest.approx(-0.602, abs=0.005)
    assert found["unlearnt_ratio_uniform_ties"].value == pytest.approx(500 / (1000 / 12))
    assert found["share_below_percepts"].value == 0.25
    assert found["frequency_ratio_random"].value == pytest.approx(1)


def test_verdicts():
    # With one task and ten at α⁰ 1 the decay is not yet that of 1/|T_s|; all else holds.
    measured = plain(measure(SETTINGS, made_up()))
    assert CLAIM.predicate.verdict(measured) == "holds in part"
    measured["slope_default"] = {"value": -0.98, "median": -0.98, "ci95": [-0.99, -0.97], "n": 3}
    assert CLAIM.predicate.verdict(measured) == "holds"
    measured["share_below_states"]["value"] = 0.25
    assert CLAIM.predicate.verdict(measured) == "holds in part"
    poor = plain(measure(SETTINGS, made_up(scale=1.2, below=1))) | {
        "prior_error_states": {"value": 0.1, "median": 0.1, "ci95": None, "n": 3}
    }
    assert CLAIM.predicate.verdict(poor) == "does not hold"


def test_rows_and_figure():
    cells = made_up()
    found = rows(SETTINGS, cells)
    case = next(row for row in found if row.get("alike") == 1 and row["tasks"] == 1)
    assert case["measured"] == pytest.approx(1 / 3, abs=1e-3)
    assert case["low"] < 1 / 3 < case["high"]
    world = next(row for row in found if "kind" in row)
    assert (world["worlds"], world["entering"], world["below_percepts"]) == (3, 12, 3)
    assert world["least"] == [2.0] * 3
    assert world["least_percepts"] == [0.8, 0.76, 0.72]
    result = {"settings": SETTINGS, "measured": plain(measure(SETTINGS, cells)), "rows": found}
    states, percepts, worlds = CLAIM.draw(result).axes
    assert states.get_legend_handles_labels()[1] == ["α⁰ = 1"]
    assert percepts.get_legend_handles_labels()[1] == ["|T| · 1", "|T| · 2"]
    assert [tick.get_text() for tick in worlds.get_yticklabels()] == ["random, 1"]


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"tasks": "[1, 3, 10]"}, "tasks must hold 0"),
        ({"tasks": "[0, 1]"}, "two other numbers"),
    ],
)
def test_settings_that_limits_cannot_describe(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)
