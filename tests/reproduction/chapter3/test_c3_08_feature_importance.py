"""Measures of C3.8 from made-up importances, by hand, and importances of counts worked by hand."""

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.domains.factory.contexts import PHI
from reproduction.chapter3.c3_08_feature_importance.run import grid_of, importance, rows
from reproduction.chapter3.factory.modified_tasks import FULL_SET
from reproduction.engine.registry import claim_of

QUICK = dict(claim_of("C3.8").sizes["quick"])

SETTINGS = {**QUICK, "runs": 4, "policies": [3], "over": ["all", "way"], "actions": ["tied"]}
"""A grid of two cells."""
OTHERS = {"PosMM": 0.03, "Items": 0.02}


def increases(run, others):
    """Δ by set: the four cells from 0.10 on, more by run; diagonals 0.04 in φ4."""
    delta = {"PosUM": 0.10, "PosML": 0.11, "PosMR": 0.12, "PosDM": 0.13}
    delta = {name: value + 0.001 * run for name, value in delta.items()} | others
    return {phi: {name: delta.get(name, 0.04) for name in names} for phi, names in PHI.items()}


def made_up(way=OTHERS):
    def numbers(how, run):
        return {**how, "increase": increases(run, way if how["over"] == "way" else OTHERS)}

    return [{"run": run, "found": [numbers(how, run) for how in grid_of(SETTINGS).cells]} for run in range(4)]


def test_gaps_by_hand():
    found, _ = claim_of("C3.8").measured(SETTINGS, made_up())
    # The least of the four is 0.10 + 0.001 r, 0.1015 on average.
    assert found["gap_phi4"].value == pytest.approx(0.1015 - 0.04)
    assert found["gap_phi3"].value == pytest.approx(0.1015 - 0.03)
    assert found["gap_phi2_to_phi1"].value == pytest.approx(0.1015 - 0.03)
    assert (found["least_of_four"].value, found["largest_other"].value) == pytest.approx((0.1015, 0.04))
    south = next(row for row in rows(SETTINGS, made_up()) if (row["set"], row["feature"]) == ("phi3", "PosDM"))
    assert south["value"] == pytest.approx(0.1315)


def test_importance_of_counts_by_hand():
    # Only N tells: where it is free (0) go north, where it is a wall (1) south, six states each.
    values = np.zeros((12, 10), np.int64)
    values[6:, FULL_SET.names.index("PosUM")] = 1
    values[::2, FULL_SET.names.index("Items")] = 1
    best = np.zeros((12, 6), bool)
    best[:6, 0] = best[6:, 1] = True
    prior = ActionPrior(6)
    prior.update(FULL_SET.codes(values), best)
    found = importance(prior)
    # Without N both actions are as likely: one bit. φ1 has no N.
    assert found["phi4"] == {name: float(name == "PosUM") for name in FULL_SET.names}
    assert found["phi1"] == {"PosMM": 0.0, "Items": 0.0}
