"""Measures of C3.11 from made-up cells, by hand."""

import numpy as np
import pytest

from reproduction.chapter3.c3_11_forms_of_prior.measure import BOUNDS, measure, rows
from reproduction.chapter3.c3_11_forms_of_prior.run import (
    AS_PRINTED,
    DIRICHLET,
    FORMS,
    PROPORTION,
    WITHOUT_PRIOR,
    grid_of,
)
from reproduction.engine.grid import run_grid
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C3.11")
QUICK = dict(claim_of("C3.11").sizes["quick"])

SETTINGS = {
    **QUICK,
    "runs": 4,
    "episodes": 3,
    "early": 2,
    "features": ["phi3"],
    "schedules": [[1.0, 0.95, 0.01]],
    "alpha0": [0.1],
    "max_steps": [200],
    "policies": [3],
}
"""A grid of two cells, ties uniform and by the prior, by four softmaxes."""
EARLY = {WITHOUT_PRIOR: -5000.0, PROPORTION: -1000.0, DIRICHLET: -1010.0, AS_PRINTED: -3000.0}
SPREAD = {WITHOUT_PRIOR: 900.0, PROPORTION: 200.0, DIRICHLET: 250.0, AS_PRINTED: 800.0}


def made_up(early=EARLY, spread=SPREAD, apart=1.0):
    """Cells of four runs; softmaxes not named are as good as proportions, every number a bit `apart` by run."""

    def numbers(form, run):
        place = FORMS.index(form) if form in FORMS else 0
        jitter = np.array([-3.0, 1.0, -1.0, 3.0])[(run + place) % 4] * (1 + 0.1 * place) * apart
        value = early.get(form, early[PROPORTION]) + jitter
        found = {"early": value, "all": value, "spread_early": spread.get(form, spread[PROPORTION]) + jitter}
        return {**found, "mean": [value] * 3, "deviation": [1.0 + run] * 3}

    cells = []
    for run in range(4):
        found = run_grid(
            grid_of(SETTINGS), "form", WITHOUT_PRIOR, FORMS, lambda form, _, run=run: numbers(form, run)
        )
        cells.append({"run": run, "optimal": -20.0, "optimal_size": 50.0, "found": list(found)})
    return cells


def plain(measured):
    return {name: number.to_dict() for name, number in measured.items()}


def test_headline_by_hand():
    found = measure(SETTINGS, made_up())
    # The jitter is shifted by form and cancels over the four runs.
    assert found["proportion_minus_softmax"].value == pytest.approx(2000)
    assert found["early_dirichlet_minus_softmax"].value == pytest.approx(1990)
    assert found["early_spread_ratio_softmax_to_proportion"].value == pytest.approx(4)
    assert found["early_spread_ratio_softmax_to_dirichlet"].value == pytest.approx(3.2)
    # Learning without a prior lies 4980 below the optimum.
    assert found["dirichlet_minus_proportion_of_distance"].value == pytest.approx(-10 / 4980)
    assert found["dirichlet_minus_proportion_of_optimal"].value == pytest.approx(-10 / 50)


def test_shares_of_the_grid_by_hand():
    found = measure(SETTINGS, made_up())
    # Of four softmaxes in two cells only the printed one is apart from proportions.
    assert found["grid_softmax_poor_and_spread"].value == 0.25
    assert found["grid_softmax_poor_and_spread"].n == 8
    worse = dict.fromkeys(FORMS[2:], -3000.0) | {key: EARLY[key] for key in (WITHOUT_PRIOR, PROPORTION, DIRICHLET)}
    found = measure(SETTINGS, made_up(worse))
    # All earn less then, but only the printed one spreads more.
    assert found["grid_softmax_poor_and_spread"].value == 0.25


ALL = {WITHOUT_PRIOR: -5000.0, PROPORTION: -1000.0, DIRICHLET: -1001.0, AS_PRINTED: -3000.0}
"""Proportions and the Dirichlet within 1 of each other, 2 % of the optimal reward's size."""
GRID_SHARES = ("grid_printed_sentence", "grid_printed_softmax_below", "grid_printed_sentence_by_means")


def in_one_cell(cells, form, **numbers):
    """The same cells, but that `form` has other numbers in the second cell of the grid, ties by the prior."""
    changed = [
        {**found, **numbers} if found["form"] == form and found["ties"] == "prior" else found
        for cell in cells
        for found in cell["found"]
    ]
    each = len(cells[0]["found"])
    return [{**cell, "found": changed[i * each : (i + 1) * each]} for i, cell in enumerate(cells)]


def test_the_sentence_in_cells_of_the_printed_softmax_by_hand():
    cells = made_up(ALL, apart=0.01)
    found = measure(SETTINGS, cells)
    # Two cells, ties uniform and by the prior; the other softmaxes, as good as proportions, do not count.
    assert (found["grid_printed_sentence"].value, found["grid_printed_sentence"].n) == (1.0, 2)
    assert found["grid_printed_softmax_below"].value == found["grid_printed_sentence_by_means"].value == 1.0
    # In one cell the printed softmax spreads less than the Dirichlet, though more than proportions.
    found = measure(SETTINGS, in_one_cell(cells, AS_PRINTED, spread_early=230.0))
    assert [found[name].value for name in GRID_SHARES] == [0.5, 0.5, 0.5]
    # In one cell it earns more over all episodes.
    found = measure(SETTINGS, in_one_cell(cells, AS_PRINTED, all=-900.0))
    assert [found[name].value for name in GRID_SHARES] == [0.5, 0.5, 0.5]
    # In one cell the Dirichlet earns 10 less than proportions, a fifth of the optimal reward's size.
    found = measure(SETTINGS, in_one_cell(cells, DIRICHLET, all=-1010.0))
    assert [found[name].value for name in GRID_SHARES] == [0.5, 1.0, 0.5]


def test_a_cell_in_doubt_counts_by_its_means_only():
    # Over four runs the Dirichlet differs by 0 ± 4 from proportions in the mean of all episodes.
    found = measure(SETTINGS, made_up({**ALL, DIRICHLET: -1000.0}))
    assert [found[name].value for name in GRID_SHARES] == [0.0, 1.0, 1.0]


def test_bounds_in_the_grid_are_those_of_the_headline():
    headline = [one.condition for one in CLAIM.second.conditions if one.role == "headline"]
    asked = {c.measure: c.bound if c.op == "between" else (c.bound, np.inf) for c in headline}
    assert asked == BOUNDS
    assert {c.op for c in headline} == {"between", ">"}


def test_the_grid_of_the_second_reading_is_of_the_printed_softmax():
    roles = {one.condition.measure: one.role for one in CLAIM.second.conditions}
    assert roles["grid_printed_sentence"] == "grid"
    assert roles["grid_softmax_poor_and_spread"] == roles["grid_printed_sentence_by_means"] == "own"
    # The variants succeed in half of the first grid, the printed softmax at no cell: not even in part.
    poor = dict.fromkeys(FORMS[3:], -3000.0) | {key: ALL[key] for key in (WITHOUT_PRIOR, PROPORTION, DIRICHLET)}
    wide = dict.fromkeys(FORMS[3:], 800.0) | {key: SPREAD[key] for key in (WITHOUT_PRIOR, PROPORTION, DIRICHLET)}
    numbers = plain(measure(SETTINGS, made_up({**poor, AS_PRINTED: -500.0}, {**wide, AS_PRINTED: 100.0})))
    assert numbers["grid_softmax_poor_and_spread"]["value"] == 0.75
    assert CLAIM.second.verdict(numbers) == "does not hold"
    assert CLAIM.second.verdict(plain(measure(SETTINGS, made_up(ALL, apart=0.01)))) == "holds"


def test_verdicts():
    every = dict.fromkeys(FORMS[2:], -3000.0) | {key: EARLY[key] for key in (WITHOUT_PRIOR, PROPORTION, DIRICHLET)}
    wide = dict.fromkeys(FORMS[2:], 800.0) | {key: SPREAD[key] for key in (WITHOUT_PRIOR, PROPORTION, DIRICHLET)}
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up(every, wide)))) == "holds"
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up()))) == "holds in part"
    # A softmax that earns more and spreads less, whatever the Dirichlet does.
    better, narrow = {**EARLY, AS_PRINTED: -500.0}, {**SPREAD, AS_PRINTED: 100.0}
    assert CLAIM.predicate.verdict(plain(measure(SETTINGS, made_up(better, narrow)))) == "does not hold"


def test_rows_hold_the_whole_grid_and_its_curves():
    found = rows(SETTINGS, made_up())
    grid = [row for row in found if "features" in row]
    assert [row["ties"] for row in grid] == ["uniform", "prior"]
    assert grid[0]["early_difference_softmax_of_counts"]["value"] == pytest.approx(2000)
    assert grid[1]["early_spread_ratio_dirichlet"]["value"] == pytest.approx(1.25)
    curves = {row["curve_of"]: row for row in found if "curve_of" in row}
    assert list(curves) == [WITHOUT_PRIOR, *FORMS]
    np.testing.assert_allclose(curves[AS_PRINTED]["mean"], -3000)
    assert curves[AS_PRINTED]["deviation"] == [2.5] * 3


def test_every_condition_asks_of_something_measured():
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(measure(SETTINGS, made_up()))


def test_the_figure_is_drawn_from_rows_alone():
    cells = made_up()
    result = {"settings": SETTINGS, "measured": plain(measure(SETTINGS, cells)), "rows": rows(SETTINGS, cells)}
    curves, difference, ratio = CLAIM.draw(result).axes
    assert [line.get_label() for line in curves.lines] == [WITHOUT_PRIOR, *FORMS, "optimal"]
    assert [text.get_text() for text in difference.texts][:2] == ["+10", "+2,000"]
    assert [text.get_text() for text in ratio.texts][:3] == ["1.25", "4.00", "1.00"]
    assert [tick.get_text() for tick in difference.get_yticklabels()] == [
        "φ3, ε 1 × 0.95, ties uniform",
        "φ3, ε 1 × 0.95, ties prior",
    ]
