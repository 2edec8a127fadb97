"""C4.8: regret against both bests by hand, and a tiny run."""

import json

import numpy as np
import pytest

from lifelore.core.errors import InputError
from reproduction.chapter4.c4_08_library_size.measure import measure, rows
from reproduction.chapter4.c4_08_library_size.run import run_cell
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.8")
QUICK = dict(claim_of("C4.8").sizes["quick"])

SMALL = {**QUICK, "trials": 4, "shares": [0.1, 1.0], "episodes": [2, 6], "samples": 3}


@pytest.fixture(scope="module")
def cells():
    return json.loads(json.dumps([run_cell(SMALL, cell, 1) for cell in CLAIM.cells(SMALL)]))


def test_a_tiny_run(cells):
    found = measure(SMALL, cells)
    assert {c.measure for c in CLAIM.predicate.conditions} <= set(found)
    assert found["saved_by_size_late_EI_exact"].n == 4
    for cell in cells:
        whole, own = np.array(cell["all"]), np.array(cell["library"])
        assert (whole >= own).all()
        if cell["share"] == 1.0:
            # The whole library's best is the best of all.
            assert (whole == own).all()
            assert cell["met"] == [1] * 4


def test_a_library_of_one_policy_has_no_regret_of_its_own():
    """Erratum: by Definition 4.3.1 the smallest library would be the best."""
    settings = {**SMALL, "shares": [0.01, 1.0]}
    found = run_cell(settings, {"rule": "EI", "model": "exact", "share": 0.01}, 1)
    assert found["library"] == [[0.0, 0.0]] * 4
    assert np.mean(found["all"]) > 100


def test_counts_by_hand():
    results = []
    for model in ("learnt", "exact", "uncertain"):
        for share, values in ((0.1, [[8.0, 4.0], [6.0, 5.0]]), (1.0, [[6.0, 1.0], [6.0, 3.0]])):
            results.append(
                {"rule": "EI", "model": model, "share": share, "all": values, "library": values, "met": [1, 0]}
            )
    found = measure(SMALL, results)
    assert found["saved_by_size_early_EI_exact"].value == 1.0
    assert found["saved_by_size_late_EI_exact"].value == 2.5
    assert found["saved_by_episodes_small_EI_exact"].value == 2.5
    assert found["steps_of_size_EI_exact"].value == 1.0
    assert found["saved_by_episodes_whole_EI_exact"].value == 4.0
    # Two trials give no interval, so nothing is certain.
    assert (found["grid_library_regret"].value, found["grid_library_regret"].n) == (0, 3)
    for result in results:
        result["library"] = result["library"] * 5
    assert measure(SMALL, results)["grid_library_regret"].value == 1
    assert rows(SMALL, results)[0]["share_met"] == 0.5


def test_the_figure_is_drawn_from_rows_alone(cells):
    kept = json.loads(json.dumps(rows(SMALL, cells)))
    figure = CLAIM.draw({"settings": SMALL, "rows": kept})
    assert len([axes for axes in figure.axes if axes.lines]) == 3


@pytest.mark.parametrize(
    ("overrides", "rule"),
    [
        ({"shares": "[1.0, 0.5]"}, "shares must be"),
        ({"episodes": "[5]"}, "episodes must be"),
        ({"rules": '["sampling"]'}, "rules must include EI"),
    ],
)
def test_settings_that_limits_cannot_describe(overrides, rule):
    with pytest.raises(InputError, match=rule):
        CLAIM.settings("quick", overrides)
