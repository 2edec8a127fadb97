"""C4.6: agreement with print by hand, and a tiny run."""

import json

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.domains.surveillance.surveillance import NOISES
from reproduction.chapter4.c4_06_regret_deviation.measure import (
    PRINTED,
    READINGS,
    agreement,
    deviations,
    late_pattern,
    measure,
    rows,
)
from reproduction.chapter4.c4_06_regret_deviation.run import METHODS, run_cell
from reproduction.chapter4.reuse.rules import OF_THESIS
from reproduction.chapter4.surveillance.runs import DEFAULT_WORLD
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.6")
QUICK = dict(claim_of("C4.6").sizes["quick"])

SMALL = {**QUICK, "tasks": 3, "groups": 3}
SHOWN = ("sampling", "EI", "eps-greedy")


@pytest.fixture(scope="module")
def cells():
    """Three rules are run; the others stand in for them, so that the test stays short."""
    found = []
    for cell in CLAIM.cells(SMALL):
        stand_in = {**cell, "method": cell["method"] if cell["method"] in SHOWN else "sampling"}
        if cell["noise"] == "variance 20":
            stand_in["noise"] = "deviation 20"
        key = json.dumps(stand_in)
        if key not in _KEPT:
            _KEPT[key] = run_cell(SMALL, stand_in, 1)
        found.append({**_KEPT[key], **cell})
    return json.loads(json.dumps(found))


_KEPT: dict[str, dict] = {}


def test_deviations_by_hand():
    result = {"groups": 2, "realised": {"5": [3.0, -3.0, 0.0, 2.0]}, "at": {"5": [0.0, 4.0, 1.0, 1.0]}}
    # Sizes 3, 3 and 0, 2; with signs 3, -3.
    assert deviations(result, "size of the difference of two pays", 5).tolist() == [0.0, 2**0.5]
    assert deviations(result, "difference of two pays", 5) == pytest.approx([18**0.5, 2**0.5])
    assert deviations(result, "expected", 5) == pytest.approx([8**0.5, 0.0])


def test_agreement_by_hand():
    spread = np.repeat(np.arange(101.0), 2)
    spread[1::2] = 0
    result = {"groups": 101, "at": {str(k): spread.tolist() for k in (5, 10, 20, 50)}}
    # Deviations of (x, 0) are x / √2 for x from 0 to 100; the middle 95 % of x lies from 2.5 to 97.5.
    printed = [2.4 / 2**0.5, 2.6 / 2**0.5, 97.4 / 2**0.5, 97.6 / 2**0.5]
    assert agreement(result, printed, "expected") == [False, True, True, False]


@pytest.mark.parametrize(
    ("changed", "holds"),
    [
        ({}, True),
        ({"KG": 30.0}, False),
        ({"PI": 40.0}, False),
        ({"PI, printed": 20.0}, False),
        ({"greedy": 90.0}, True),
    ],
)
def test_late_pattern_by_hand(changed, holds):
    wide = {"eps-greedy": 60.0, "PI": 60.0, "PI, printed": 60.0} | changed
    results = []
    for name in METHODS:
        # Regret is the deviation or its opposite, but for one percent by group.
        one = np.array([1.0, -1.0, 1.0, -1.0]) * wide.get(name, 10.0) * np.array([[1.0], [1.01], [0.99]])
        found = {"groups": 3, "at": {"50": one.ravel().tolist()}}
        results.append({"method": name, "case": "exact", **DEFAULT_WORLD, **found})
    form = ", printed" if "PI, printed" in changed else ""
    assert late_pattern(results, "exact", form, "expected") is holds


def test_the_printed_table_has_six_rules_and_four_episodes():
    assert set(PRINTED) == set(OF_THESIS)
    assert {len(numbers) for numbers in PRINTED.values()} == {4}


def test_a_tiny_run(cells):
    found = measure(SMALL, cells)
    # Two forms of three cases by four readings.
    assert found["grid_late_pattern"].n == 24
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(found)
    assert found["agree_all_exact"].n == 24
    assert set(cells[0]) == {
        "method",
        "case",
        "layout",
        "metric",
        "noise",
        "groups",
        "at",
        "against_mean",
        "realised",
    }


def test_the_figure_is_drawn_from_rows_alone(cells):
    kept = json.loads(json.dumps(rows(SMALL, cells)))
    assert len(kept) == len(cells) * len(READINGS)
    figure = CLAIM.draw({"settings": SMALL, "rows": kept})
    assert [axes.get_title("left") for axes in figure.axes] == list(PRINTED)


def test_only_the_size_of_a_difference_with_deviation_20_can_leave_what_is_printed():
    """Erratum: what has converged varies by noise alone; print has 10 to 19 after 20 and 50 episodes."""
    late = [n for rule in ("sampling", "BE", "EI") for n in PRINTED[rule][2:]]
    luck = np.random.default_rng(0).standard_normal((4000, 2, 10))
    sizes = {}
    for noise, deviation in NOISES.items():
        differences = deviation * (luck[:, 0] - luck[:, 1])
        sizes[noise] = np.quantile(np.abs(differences).std(axis=1, ddof=1), [0.025, 0.975])
    low, high = sizes["deviation 20"]
    assert low <= min(late)
    assert max(late) <= high
    assert sizes["variance 20"][1] < min(late)
    # With its sign the difference varies by 20 √2, and groups of ten leave less than 15 seldom.
    signed = np.quantile((20 * (luck[:, 0] - luck[:, 1])).std(axis=1, ddof=1), 0.025)
    assert sum(n < signed for n in late) >= 3


def test_settings_that_limits_cannot_describe():
    with pytest.raises(InputError, match="after must be"):
        CLAIM.settings("quick", {"after": "[5, 10]"})
