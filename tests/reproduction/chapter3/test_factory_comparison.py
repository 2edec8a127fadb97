"""Comparisons of rewards from made-up records, by hand."""

import numpy as np
import pytest

from lifelore.core.learning.curve import new_curve
from reproduction.chapter3.factory.comparison import Comparison, grid_of, summary

SETTINGS = {"schedule": ["printed", [0.1, 1.0, 0.1]], "ties": ["uniform", "prior"], "alpha0": [0.1, 1.0]}
GRID = grid_of(SETTINGS, ("schedule", "ties"), ("alpha0",))


def test_without_a_prior_neither_ties_nor_pseudo_counts_matter():
    assert [cell["schedule"] for cell in GRID.cells_of("uniform")] == SETTINGS["schedule"]


def curve(rewards):
    found = new_curve(len(rewards))
    found.rewards[:] = rewards
    return found


def test_summary_by_hand():
    # Two tasks, four episodes; deviations (n - 1) of two numbers are their distance over the root of 2.
    curves = [curve([-8, -4, 0, 2]), curve([-4, -4, 4, 6])]
    found = summary(curves, 2, drawn=True)
    assert found.pop("rewards") == [[-8, -4, 0, 2], [-4, -4, 4, 6]]
    assert found == pytest.approx({"early": -5.0, "all": -1.0, "spread": 2 * 2**-0.5})
    # Opposite ups and downs spread every episode, and not the means of the tasks.
    opposite = [curve([0, 2]), curve([2, 0])]
    assert summary(opposite, 2, drawn=False)["spread"] == pytest.approx(2 * 2**-0.5)
    assert "spread" not in summary(opposite[:1], 9, drawn=False)


def made_up():
    """Four runs: no prior earns -1000 early, the prior -200; both vary by run."""
    rewards = {"uniform": -1000.0, "prior": -200.0}
    return [
        {
            "optimal": 100.0,
            "found": [
                {"method": method, **cell, "all": of + run, "early": 2 * of, "rewards": [[of, of + 2 * run]]}
                for method, of in rewards.items()
                for cell in GRID.cells_of(method)
            ],
        }
        for run in range(4)
    ]


def test_shares_of_the_distance_by_hand():
    found = Comparison(made_up(), GRID)
    pairs = {"gain": ("prior", "uniform"), "early_gain": ("prior", "uniform", "early")}
    for cell in GRID.cells:
        shares = found.shares(cell, pairs)
        # Without a prior: -998.5 in the mean of runs 0 … 3, 1098.5 below the optimum; early -2000 and 2100.
        assert shares["gain"].value == pytest.approx(800 / 1098.5)
        assert shares["early_gain"].value == pytest.approx(1600 / 2100)
    row = found.curve("prior", GRID.default)
    assert row["mean"] == [-200.0, -197.0]
    assert row["deviation"] == [0.0, round(float(np.std([0, 2, 4, 6], ddof=1)), 1)]


def test_a_cell_counts_once_for_each_pair():
    grid = grid_of(SETTINGS, ("schedule", "ties"), ("alpha0",), {"prior": ("schedule", "ties")})
    found = Comparison(made_up(), grid)
    # Neither method reads α⁰: the last cell is the default once more.
    assert [found.is_own(cell, "prior", "uniform") for cell in grid.cells] == [True] * 4 + [False]
    assert [found.is_own(cell, "uniform") for cell in grid.cells] == [True, False, True, False, False]
    assert found.is_own(grid.cells[-1], "prior", "another")
