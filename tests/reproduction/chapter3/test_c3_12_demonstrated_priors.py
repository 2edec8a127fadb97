"""Measures of C3.12 from made-up cells, by hand."""

import pytest

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate
from reproduction.chapter3.c3_12_demonstrated_priors.measure import is_comparable, measure, rows
from reproduction.chapter3.c3_12_demonstrated_priors.run import (
    PEOPLE,
    SELF,
    SHOWN,
    WEIGHTS,
    WITHOUT_PRIOR,
    grid_of,
)
from reproduction.engine.grid import run_grid
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.12")
QUICK = dict(claim_of("C3.12").sizes["quick"])

SETTINGS = {
    **QUICK, "runs": 4, "episodes": 3, "early": 2, "features": ["phi3"], "schedules": [[1.0, 0.95, 0.01]],
    "alpha0": [0.1], "ties": ["uniform", "prior"], "trajectories": [4], "people": ["familiar", "varied"],
}  # fmt: skip
"""A grid of two cells, ties uniform and by the prior."""


def made_up(shown=-1020.0, varied=-1300.0, own=-1000.0, plain=-3000.0):
    """Four runs; optimal is 0, so the distance from no prior is 3000 or so."""

    def numbers(value, run):
        value += (-3.0, 1.0, -1.0, 3.0)[run]
        return {
            **dict.fromkeys(("all", "early"), value),
            "mean": [value] * 3,
            "deviation": [1.0 + run] * 3,
        }

    cells = []
    for run in range(4):
        by_method = {
            WITHOUT_PRIOR: numbers(plain, 3 - run),
            SELF: numbers(own, run),
            SHOWN: numbers(shown, (run + 1) % 4),
        }
        found = run_grid(
            grid_of(SETTINGS), "method", WITHOUT_PRIOR, (SELF, SHOWN), lambda method, _, by=by_method: by[method]
        )
        groups = [
            {"people": people, "weight": weight, **numbers(value, (run + 1) % 4)}
            for people, value in (("familiar", shown), ("varied", varied))
            for weight in WEIGHTS
        ]
        people = [
            {
                "people": name, "given_up": 1, "steps": 100 + run,
                "weights": {w: {f"person {i}": s for i, s in enumerate(PEOPLE[name])} for w in WEIGHTS},
            }
            for name in SETTINGS["people"]
        ]  # fmt: skip
        cells.append(
            {
                "run": run,
                "optimal": 0.0,
                "optimal_size": 50.0,
                "found": list(found),
                "groups": groups,
                "people": people,
            }
        )
    return cells


def plain(measured):
    return {name: number.to_dict() for name, number in measured.items()}


def test_numbers_by_hand():
    found = measure(SETTINGS, made_up())
    assert found["shown_minus_self_of_distance"].value == pytest.approx(-20 / 3000)
    assert found["shown_minus_self_of_optimal"].value == pytest.approx(-20 / 50)
    assert found["grid_comparable_of_optimal"].value == 0.0
    alike = [{**result, "optimal_size": 5000.0} for result in made_up()]
    assert measure(SETTINGS, alike)["grid_comparable_of_optimal"].value == found["grid_comparable"].value > 0
    assert found["varied_minus_self_of_optimal"].value == pytest.approx(-300 / 50)
    assert found["varied_minus_self_of_distance"].value == pytest.approx(-0.1)
    assert found["shown_minus_uniform"].value == pytest.approx(1980)
    assert found["self_minus_uniform"].value == pytest.approx(2000)
    assert found["grid_comparable"].value == 1
    assert found["given_up_familiar"].value == 1
    assert found["steps_varied"].value == 101.5
    assert found["weight_varied_3_by_ways"].value == 0.5


def test_comparable_is_within_five_percent_by_the_interval():
    assert is_comparable(Estimate(0.0, 0.0, (-0.05, 0.02), 4))
    assert not is_comparable(Estimate(0.0, 0.0, (-0.06, 0.02), 4))
    assert not is_comparable(Estimate(0.0, 0.0, None, 2))


def test_verdicts():
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up()))) == "holds"
    # Better than none, but not as good as self-trained.
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up(shown=-2000.0)))) == "holds in part"
    poor = measure(SETTINGS, made_up(shown=-4000.0, varied=-4000.0, own=-3500.0))
    assert CLAIM.predicate.verdict(plain(poor)) == "does not hold"


def test_every_condition_asks_of_something_measured():
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(measure(SETTINGS, made_up()))


def test_rows_and_figure():
    cells = made_up()
    found = rows(SETTINGS, cells)
    assert [row["ties"] for row in found if "features" in row] == ["uniform", "prior"]
    by_steps = next(row for row in found if (row.get("people"), row.get("weight")) == ("varied", "by steps"))
    assert by_steps["of_distance"]["value"] == pytest.approx(-0.1)
    assert len([row for row in found if "weight" in row]) == 2 * len(WEIGHTS)
    assert [row["curve_of"] for row in found if "curve_of" in row] == [WITHOUT_PRIOR, SELF, SHOWN]
    result = {"settings": SETTINGS, "measured": plain(measure(SETTINGS, cells)), "rows": found}
    curves, grid, people = CLAIM.draw(result).axes
    assert len(curves.lines) == 4
    # 20 and 300 below the self-trained prior, over the optimum's size, 50, and over the distance, 3000.
    shown, varied = "−0.4 ×\n(−0.7 %)", "−6.0 ×\n(−10.0 %)"
    assert [text.get_text() for text in grid.texts] == [shown] * 2
    assert [text.get_text() for text in people.texts] == [shown] * 3 + [varied] * 3
    assert people.get_yticklabels()[1].get_text() == "varied\n(1, 0.9, 0.7, 0.5)"


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"people": '["familiar"]'}, "people must hold varied"),
    ],
)
def test_settings_that_limits_cannot_describe(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)
