"""Measures of C3.2 from made-up cells, by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.experiments.chapter3.c3_02_lattice_prior.measure import measure, rows
from lifelore.experiments.chapter3.c3_02_lattice_prior.run import PLAIN, configurations
from lifelore.experiments.engine.curve_blocks import block_edges
from lifelore.experiments.engine.registry import claim_of

CLAIM = claim_of("C3.2")
QUICK = dict(claim_of("C3.2").sizes["quick"])

SETTINGS = {
    **QUICK,
    "runs": 4,
    "schedules": [[1.0, 0.98, 0.01]],
    "forms": ["proportion", "support"],
    "alpha0": [0.1],
    "online_tasks": [0, 5],
}
"""A grid of four cells: proportion and support, ties uniform and by the prior."""


def made_up(first_of, to_80_of):
    """Cells of four runs; the functions give a configuration's number in a run, Q-learning -40 and 100."""
    n_blocks = len(block_edges(SETTINGS["episodes"])) - 1

    def method(how, first, to_80):
        numbers = {
            "first": first,
            "first_ten": first,
            "to_50": to_80 // 2,
            "to_80": to_80,
            "never_80": to_80 >= 120,
        }
        return {**how, **numbers, "never_50": False, "final": 0.9, "curve": [first] * n_blocks}

    found = []
    for run in range(4):
        methods = [method(PLAIN, -40.0 + run, 100 + run)]
        methods += [method(how, first_of(how, run), to_80_of(how, run)) for how in configurations(SETTINGS)]
        found.append(
            {"kind": "grid", "schedule": [1.0, 0.98, 0.01], "run": run, "optimal": 50.0, "methods": methods}
        )
    for run in range(4):
        first_ten = {"exact_0": -60.0, "learnt_0": -60.0, "exact_5": 2.0 + run, "learnt_5": 1.0 + run}
        found.append(
            {"kind": "online", "run": run, "optimal": 50.0, "plain": -60.0, "same": True, "first_ten": first_ten}
        )
    return found


def by_ties(how, run):
    return (5.0 if how["ties"] == "prior" else -5.0) + 0.1 * run


def slower_for_proportion(how, run):
    return (110 if how["form"] == "proportion" else 50) + run


def test_headline_and_grid_shares_by_hand():
    found = measure(SETTINGS, made_up(by_ties, slower_for_proportion))
    assert found["first_eps_qsap"].value == pytest.approx(-5 + 0.15)
    assert found["first_q_learning"].value == pytest.approx(-38.5)
    assert found["to_80_ratio"].value == pytest.approx(111.5 / 101.5)
    assert found["grid_positive_at_once"].value == 0.5
    assert found["grid_faster_to_80"].value == 0.5
    assert found["grid_both"].value == 0.25
    assert found["grid_both"].n == 4
    assert found["optimal_return"].value == 50.0


def test_online_measures_by_hand():
    found = measure(SETTINGS, made_up(by_ties, slower_for_proportion))
    assert found["online_gain_after_0_learnt"].value == 0.0
    assert found["online_gain_after_5_learnt"].value == pytest.approx(62.5)
    assert found["online_gain_after_5_exact"].value == pytest.approx(63.5)
    assert found["online_minus_exact_of_optimal"].value == pytest.approx(-1 / 50)
    assert found["q_learning_is_uniform_prior"].value == 1.0


def test_rows_hold_the_whole_grid_and_its_curves():
    found = rows(SETTINGS, made_up(by_ties, slower_for_proportion))
    grid = [row for row in found if "to_80_ratio" in row]
    assert len(grid) == 5
    assert grid[0]["form"] is None
    assert grid[0]["to_80_ratio"]["value"] == 1.0
    curves = [row for row in found if "curve_of" in row]
    assert [row["curve_of"]["ties"] for row in curves] == [None, "uniform", "prior"]
    # Q-learning's curve is -40, -39, -38, -37: mean -38.5, standard error 1.2910/2, t(3) = 3.1824.
    np.testing.assert_allclose(curves[0]["mean"], -38.5)
    np.testing.assert_allclose(curves[0]["high"], -38.5 + 3.18245 * 1.29099 / 2, rtol=1e-5)


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"forms": '["magic"]'}, "forms must be among"),
        ({"alpha0": "[1.0]"}, "default must be a cell of the grid"),
        ({"training_tasks": 7}, "online_tasks must contain 0 and training_tasks"),
        ({"window": 1000}, "window"),
        ({"runs": 0}, "runs"),
        ({"size": 8}, "size of a lattice must be odd"),
        ({"test_tasks": 4000}, "test_tasks must be at most the 40 cells"),
        ({"online_tasks": [0, 5, 4000]}, "online_tasks must be at most"),
        ({"learning_rate": 2.0}, "learning_rate must lie in"),
        ({"schedules": "[[1.0, 0.98]]"}, "three decimals"),
        ({"schedules": "[[1.0, 0.98, 0.01], [2.0, 1.0, 0.1]]"}, "three decimals"),
    ],
)
def test_settings_that_cannot_be_run(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)
