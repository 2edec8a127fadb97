"""Measures of C3.5 and C3.6 from made-up sequences, by hand, and a sequence of few episodes."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from reproduction.chapter3.c3_05_one_component.measure import measure, rows
from reproduction.chapter3.c3_05_one_component.run import cells, run_cell
from reproduction.chapter3.c3_06_four_components import measure as c3_6
from reproduction.chapter3.factory.learning import grid_of
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.5")
QUICK = dict(CLAIM.sizes["quick"])
SETTINGS = {**QUICK, "components": [1], "encodings": ["global", "phase"], "ties": ["uniform"]}
"""Sequences of seven tasks, the last two late; a grid of two cells."""
N = np.arange(7)


def series(run, k=1, per_task=10.0):
    rewards = {
        "uniform": [-100.0] * 7,
        "exact global": (-100 + per_task * N + run * (N > 0)).tolist(),
        "exact phase": (-100 + 10.0 * N[::-1]).tolist(),
        "own global": [-100.0] * 7,
        "own phase": [-95.0] * 7,
    }
    # The fifth task was met before, the last one is new, save in run 3.
    seen = [False] * 5 + [True, run == 3]
    found = {"kind": "series", "components": k, "run": run, "rewards": rewards}
    return {**found, "optimal": [100.0] * 7, "seen": seen, "met": 3 + run % 2}


def grid(run):
    gains = {"global": [5.0, 20.0 + run], "phase": [50.0, 50.0]}
    grid = grid_of(SETTINGS)
    found = [{"prior": "uniform", **cell, "rewards": [-100.0, -100.0]} for cell in grid.cells_of("uniform")]
    for cell in grid.cells:
        found.append({"prior": "learnt", **cell, "rewards": [-100.0 + g for g in gains[cell["encoding"]]]})
    return {"kind": "grid", "run": run, "found": found, "optimal": 100.0}


RESULTS = [series(run) for run in range(4)] + [grid(run) for run in range(4)]


def test_gains_by_hand():
    found = measure(SETTINGS, RESULTS)
    # Gains of run r: 0, then 10 n + r.
    assert found["gain_after_0"].value == 0.0
    assert found["gain_late"].value == pytest.approx(56.5)
    assert found["growth"].value == pytest.approx(40.0)
    assert found["trend"].value == pytest.approx(1.0)
    assert found["late_tasks_seen"].value == pytest.approx((3 * 0.5 + 1) / 4)
    # 3, 4, 3, 4 of the nine tasks.
    assert found["share_of_tasks_met"].value == pytest.approx(3.5 / 9)
    # Met: 50 + r in runs 0..2, 55 + r in run 3; new: 60 + r in runs 0..2.
    assert found["gain_late_met"].value == pytest.approx((50 + 51 + 52 + 58) / 4)
    assert found["gain_late_new"].value == pytest.approx(61.0)
    assert found["gain_late_new"].n == 3


def test_shares_of_what_could_be_gained_by_hand():
    found = measure(SETTINGS, RESULTS)
    assert found["closed_late_exact_global"].value == pytest.approx(56.5 / 200)
    assert found["closed_late_exact_phase"].value == pytest.approx(5 / 200)
    assert found["closed_late_own_global"].value == 0.0
    assert found["closed_late_own_phase"].value == pytest.approx(5 / 200)


def test_a_gain_that_falls_has_a_falling_trend_and_one_that_never_changes_none():
    settings = {**SETTINGS, "default": {**SETTINGS["default"], "encoding": "phase"}}
    found = measure(settings, RESULTS)
    assert found["trend"].value == pytest.approx(-1.0)
    assert found["growth"].value == pytest.approx(5 - 45)
    flat = [{**r, "rewards": {**r["rewards"], "exact phase": [-90.0] * 7}} for r in RESULTS[:4]] + RESULTS[4:]
    assert measure(settings, flat)["trend"].value == 0.0


def test_shares_of_the_grid_by_hand():
    found = measure(SETTINGS, RESULTS)
    assert found["grid_gains_and_grows"].value == 0.5
    assert found["grid_gains_and_grows"].n == 2


def test_rows_hold_sequences_and_grid():
    found = rows(SETTINGS, RESULTS)
    names = [row["series"] for row in found if "series" in row]
    assert names == ["uniform", "exact global", "exact phase", "own global", "own phase", "optimal"]
    # -39, -38, -37, -36 after six tasks: mean -38.5 + 1, standard error 1.2910/2, t(3) = 3.1824.
    band = next(row for row in found if row.get("series") == "exact global")
    assert band["mean"][6] == pytest.approx(-38.5)
    assert band["high"][6] == pytest.approx(-38.5 + 3.18245 * 1.29099 / 2, rel=1e-5)
    of_global = next(row for row in found if "growth" in row and row["encoding"] == "global")
    assert of_global["few"]["value"] == pytest.approx(5 / 200)
    assert of_global["growth"]["value"] == pytest.approx((21.5 - 5) / 200)


def test_four_components_beside_one_by_hand():
    settings = {**SETTINGS, "components": [4, 1]}
    results = [series(run, 4, 5.0) for run in range(4)] + RESULTS
    found = c3_6.measure(settings, results)
    # Gains of 5 n + r and of 10 n + r, late means 27.5 + r and 55 + r, of 200.
    assert found["closed_minus_one_component"].value == pytest.approx(-27.5 / 200)
    assert found["closed_minus_one_component_phase"].value == 0.0
    assert found["gain_late"].value == pytest.approx(29.0)
    assert found["share_of_tasks_met"].value == pytest.approx(3.5 / 126)


@pytest.fixture(scope="module")
def small():
    settings = {**QUICK, "components": [1], "episodes": 12, "max_steps": 200, "ties": ["uniform"]}
    of_run = [cell for cell in cells(settings) if cell["run"] == 0]
    return settings, [run_cell(settings, cell, 2) for cell in of_run]


def test_nothing_is_gained_before_the_first_task(small):
    sequence = small[1][0]
    assert {of_method[0] for of_method in sequence["rewards"].values()} == {sequence["rewards"]["uniform"][0]}
    assert len(sequence["rewards"]) == 1 + 2 * 4
    # With one component the flag and the list's order say the same.
    assert sequence["rewards"]["exact phase"] == sequence["rewards"]["exact listed"]


def test_grid_and_sequence_agree_where_they_meet(small):
    settings, (sequence, of_grid) = small
    default = settings["default"]
    met = next(f for f in of_grid["found"] if all(f[key] == default[key] for key in default))
    # The grid's task is the sequence's last one, learnt there with the prior of all before it.
    assert met["rewards"][1] == sequence["rewards"]["exact global"][-1]
    assert of_grid["found"][0]["rewards"][0] == sequence["rewards"]["uniform"][-1]


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"late": 4}, "late must be at most half"),
        ({"grid_tasks": "[6, 1]"}, "grid_tasks must be two numbers"),
    ],
)
def test_settings_that_cannot_be_run(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)


def test_four_components_are_compared_with_one():
    with pytest.raises(InputError, match="components must be a number and 1"):
        claim_of("C3.6").settings("quick", {"components": "[4, 2]"})
