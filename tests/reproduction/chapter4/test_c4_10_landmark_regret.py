"""What landmarks cost, by hand and in a tiny run."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from reproduction.chapter4.c4_10_landmark_regret.measure import EXAMPLE, example_regret, measure, rows
from reproduction.chapter4.c4_10_landmark_regret.run import (
    RANDOM,
    parted,
    random_table,
    surveillance_table,
)
from reproduction.engine.registry import claim_of

CLAIM = claim_of("C4.10")

TINY = {
    "tables": 2,
    "tasks": 30,
    "policies": [2],
    "layouts": ["X"],
    "metrics": ["chebyshev"],
    "shares": [0.1, 0.3],
}


@pytest.fixture(scope="module")
def tiny():
    settings = CLAIM.settings("quick", TINY)
    return settings, [CLAIM.run_cell(settings, cell, 0) for cell in CLAIM.cells(settings)]


def test_the_example_reaches_two_epsilon():
    assert example_regret() == 2.0
    # The shares of the range are of 2: half of it is ε = 1.
    found = parted(np.array(EXAMPLE), 0.5, "pairwise")
    assert (found["types"], found["shared"]) == (1, 2)
    assert found["landmark"]["largest"] == 2.0
    assert (found["landmark"]["past"], found["landmark"]["none"]) == (1, 1)
    assert found["landmark"]["counts"][-1] == 1
    # Whichever stands for the other: the second's best policy costs the first nothing.
    assert found["member"] == found["landmark"]


def test_tasks_alone_in_their_type_are_not_counted():
    found = parted(np.array([[0.0, 1.0], [0.1, 1.0], [9.0, 0.0]]), 0.02, "pairwise")
    assert (found["types"], found["shared"]) == (2, 2)
    assert found["landmark"]["none"] == 2
    alone = parted(np.array([[0.0], [9.0]]), 0.1, "pairwise")
    assert (alone["shared"], alone["landmark"]["largest"]) == (0, 0.0)


@pytest.mark.parametrize("family", RANDOM)
def test_tables_of_every_family(family):
    table = random_table(np.random.default_rng(0), family, 40, 3)
    assert table.shape == (40, 3)
    again = random_table(np.random.default_rng(0), family, 40, 3)
    np.testing.assert_array_equal(table, again)


def test_smooth_tables_are_smooth_and_uniform_ones_are_not():
    steps = {
        family: np.abs(np.diff(table, axis=0)).mean() / np.ptp(table)
        for family in RANDOM
        for table in [random_table(np.random.default_rng(1), family, 200, 3)]
    }
    assert steps["smooth"] < 0.02 < 0.2 < steps["uniform"]


def test_the_reserves_tables():
    assert surveillance_table("X", "chebyshev", "targets").shape == (68, 68)
    assert surveillance_table("ring", "euclidean", "cells").shape == (324, 68)


def test_measures_by_hand():
    def found(past, shared, largest, form="pairwise"):
        summary = {"sum": 1.0, "largest": largest, "past": past, "none": 0, "counts": [1] * 20}
        return {"share": 0.1, "form": form, "types": 3, "table": 0, "shared": shared, "landmark": summary,
                "member": summary}  # fmt: skip

    results = [
        {"cell": {"family": "uniform", "policies": 2, "first": k}, "parted": [found(k, 4, 1.2), found(0, 4, 0.5)]}
        for k in range(3)
    ]
    results.append(
        {"cell": {"family": "surveillance", "layout": "X", "metric": "chebyshev", "tasks": "cells"},
         "parted": [found(0, 10, 0.9)]}
    )  # fmt: skip
    measured, kept = measure({"families": ["uniform"]}, results), rows({}, results)
    # Past ε: 0, 1 and 2 of 8 tasks.
    assert measured["tasks_within_epsilon_landmark"].value == pytest.approx(1 - 3 / 24)
    assert measured["largest_regret_in_epsilon"].value == 2.0
    assert largest([r for r in kept if r["family"] == "uniform"], "landmark") == 1.2
    assert measured["tasks_within_epsilon_landmark_surveillance"].value == 1.0
    assert len(kept) == 2
    assert kept[0]["landmark"]["past"] == pytest.approx(3 / 24)


def test_no_table_passes_two_epsilon(tiny):
    settings, results = tiny
    measured = CLAIM.measure(settings, results)
    assert measured["largest_regret_in_two_epsilon"].value == 1.0
    kept = [row for row in CLAIM.rows(settings, results) if row["form"] == "pairwise"]
    for family in (*RANDOM, "surveillance"):
        assert largest([row for row in kept if row["family"] == family], "member") <= 2.000001
    assert largest([row for row in kept if row["family"] == "uniform"], "member") > 0.1


def largest(kept, who):
    return max(row[who]["largest"] for row in kept)


def test_tiny_run_draws_its_figure(tiny):
    settings, results = tiny
    figure = CLAIM.draw({"rows": CLAIM.rows(settings, results)})
    assert len(figure.axes) == 3


def test_settings_that_limits_cannot_describe():
    with pytest.raises(InputError, match="forms must include 'pairwise'"):
        CLAIM.settings("quick", {"forms": '["ball"]'})
