"""Measures of C3.3 from made-up cells, by hand."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.experiments.chapter3.c3_03_noise_maze_prior.measure import measure, rows
from lifelore.experiments.chapter3.c3_03_noise_maze_prior.run import COMPARED, KEYS, METHODS, PLAIN, hows
from lifelore.experiments.engine.curve_blocks import block_edges
from lifelore.experiments.engine.open_choices import plain_how
from lifelore.experiments.engine.registry import claim_of

CLAIM = claim_of("C3.3")
QUICK = dict(claim_of("C3.3").sizes["quick"])

SETTINGS = {
    **QUICK,
    "runs": 4,
    "schedules": [[1.0, 0.98, 0.01]],
    "forms": ["proportion", "support"],
    "alpha0": [0.1],
    "max_steps": [200],
    "training_tasks": [5],
}
"""A grid of four cells: proportion and support, ties uniform and by the prior."""
FIRST = {PLAIN: -80.0, "qsap": -100.0, "qpap": -5.0, "qsap_noise": -60.0, "qpap_lattice": -30.0}
TO_80 = {PLAIN: 100, "qsap": 120, "qpap": 60, "qsap_noise": 100, "qpap_lattice": 90}


def made_up(changed=lambda method, how: {}):
    """Cells of four runs, numbers rising by run; `changed` replaces some of a method's in a cell of the grid."""
    n_blocks = len(block_edges(SETTINGS["episodes"])) - 1

    def numbers(method, how, run):
        base = {"first": FIRST[method], "to_80": TO_80[method], **changed(method, how)}
        first, to_80 = base["first"] + run**2 * (1 + 0.1 * (method == PLAIN)), base["to_80"] + run
        shared = {"first_ten": first, "to_50": to_80 // 2, "never_50": False, "never_80": False, "final": 0.9}
        found = {"method": method, **how, "first": first, "to_80": to_80, **shared}
        return {**found, "curve": [first] * n_blocks}

    found = []
    for run in range(4):
        grid = hows(SETTINGS)
        default = {key: SETTINGS["default"][key] for key in KEYS}
        methods = [numbers(PLAIN, plain_how(default, KEYS), run)]
        methods += [numbers(method, how, run) for how in grid for method in COMPARED]
        methods += [numbers(method, default, run) for method in METHODS if method not in COMPARED]
        found.append({"run": run, "optimal": 50.0 + run, "found": methods})
    return found


def test_headline_by_hand():
    found = measure(SETTINGS, made_up())
    # run² over four runs has the mean 14 / 4; Q-learning's is a tenth larger.
    assert found["first_qpap"].value == pytest.approx(-5 + 3.5)
    assert found["first_q_learning"].value == pytest.approx(-80 + 3.85)
    assert found["first_qpap_minus_q_learning"].value == pytest.approx(75 - 0.35)
    assert found["first_qpap_minus_qsap"].value == pytest.approx(95)
    assert found["first_qsap_minus_q_learning"].value == pytest.approx(-20 - 0.35)
    assert found["to_80_ratio_qpap_to_q_learning"].value == pytest.approx(61.5 / 101.5)
    assert found["to_80_ratio_qsap_to_q_learning"].value == pytest.approx(121.5 / 101.5)
    assert found["to_80_qpap_lattice"].value == pytest.approx(91.5)
    assert found["optimal_return"].value == pytest.approx(51.5)


def test_as_the_thesis_has_it_the_verdict_is_holds():
    # Differences need some spread for an interval: Q-learning's run² is a tenth larger, that of ε-QSAP made so.
    cells = made_up()
    for cell in cells:
        for numbers in cell["found"]:
            if numbers["method"] == "qsap":
                numbers["first"] -= 0.2 * cell["run"]
    measured = {name: number.to_dict() for name, number in measure(SETTINGS, cells).items()}
    assert CLAIM.predicate.verdict(measured) == "holds"
    measured["grid_qsap_worse"]["value"] = 0.4
    assert CLAIM.predicate.verdict(measured) == "holds in part"


def test_shares_of_the_grid_by_hand():
    def changed(method, how):
        if method == "qpap" and how["ties"] == "prior":
            return {"to_80": 119}  # above Q-learning in half of the cells
        if method == "qsap" and how["form"] == "support":
            return {"first": -40.0}  # better than Q-learning at first in half of the cells
        return {}

    found = measure(SETTINGS, made_up(changed))
    assert found["grid_qpap_faster"].value == 0.5
    assert found["grid_qpap_faster"].n == 4
    assert found["grid_qsap_worse_at_first"].value == 0.5
    assert found["grid_qsap_slower"].value == 1.0
    assert found["grid_qsap_worse"].value == 0.5
    # The made-up difference from ε-QSAP is the same in all runs: no interval, so no cell counts.
    assert found["grid_qpap_beats_both"].value == 0.0


def test_rows_hold_the_whole_grid_and_its_curves():
    found = rows(SETTINGS, made_up())
    grid = [row for row in found if "form" in row]
    assert [(row["form"], row["alpha0"], row["ties"]) for row in grid] == [
        ("proportion", 0.1, "uniform"),
        ("proportion", 0.1, "prior"),
        ("support", None, "uniform"),
        ("support", None, "prior"),
    ]
    assert grid[0]["to_80_qsap"]["value"] == 121.5
    curves = {row["curve_of"]: row for row in found if "curve_of" in row}
    assert list(curves) == [PLAIN, *METHODS]
    # ε-QPAP's curve is -5, -4, -1, 4: mean -1.5, deviation sqrt(49 / 3), t(3) = 3.18245.
    np.testing.assert_allclose(curves["qpap"]["mean"], -1.5)
    np.testing.assert_allclose(curves["qpap"]["high"], -1.5 + 3.18245 * (49 / 3) ** 0.5 / 2, rtol=1e-5)


def test_every_condition_asks_of_something_measured():
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(measure(SETTINGS, made_up()))


def test_the_figure_is_drawn_from_rows_alone():
    cells = made_up()
    measured = {name: number.to_dict() for name, number in measure(SETTINGS, cells).items()}
    figure = CLAIM.draw({"settings": SETTINGS, "measured": measured, "rows": rows(SETTINGS, cells)})
    above, below, *grids = figure.axes
    assert len(grids) == 6
    assert len(below.patches) == 5
    assert [text.get_text() for text in grids[1].texts][:2] == ["+95.0", "+95.0"]
    assert [text.get_text() for text in grids[3].texts][:2] == ["0.61", "0.61"]
    assert [tick.get_text() for tick in grids[0].get_yticklabels()] == ["proportion, α⁰ 0.1", "support"]
    assert "ε-QPAP, noise mazes" in [line.get_label() for line in above.lines]


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"forms": '["magic"]'}, "forms must be among"),
        ({"alpha0": "[1.0]"}, "its alpha0 is not"),
        ({"max_steps": "[100]"}, "its max_steps is not"),
        ({"training_tasks": "[]"}, "training_tasks must be at least 1"),
        ({"training_tasks": "[5, 600]"}, "training_tasks must be at most the lattice's"),
        ({"window": 1000}, "window must be at most episodes"),
        ({"runs": 0}, "runs must be at least 1"),
        ({"size": 8}, "size of a lattice must be odd"),
        ({"density": "[0.8, 0.5]"}, "density must be two shares"),
        ({"density": "[0.5]"}, "density must be two shares"),
        ({"learning_rate": 2.0}, "learning_rate must lie in"),
        ({"schedules": "[[1.0, 0.98]]"}, "three decimals"),
    ],
)
def test_settings_that_cannot_be_run(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)
