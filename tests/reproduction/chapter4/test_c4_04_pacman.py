"""Powers of ten between episodes from made-up tasks, by hand."""

import pytest

from lifelore.core.errors import InputError
from reproduction.chapter4.c4_04_pacman.run import LASTING, RETURNS, readings
from reproduction.engine.registry import claim_of

SETTINGS = {"episodes": 10_000}


def layout(bpr, q, prq, as_paid):
    """A layout of one task."""
    task = {
        "reuse": {"10 returns": {RETURNS: bpr, LASTING: None}, "exact": {RETURNS: 1, LASTING: 1}},
        "learners": {"Q-learning": q, "PRQ in [0, 1]": prq, "PRQ as paid": as_paid},
        "curves": {name: [1.0, float(bpr)] for name in ("BPR", "PRQ in [0, 1]", "Q-learning")},
        "best": 140.0,
    }
    return {"tasks": [task]}


RESULTS = [layout(1, 1000, 100, 10), layout(10, None, 1000, 10), layout(1, 100, 10_000, 10)]


def test_powers_of_ten_by_hand():
    found, _ = claim_of("C4.4").measured(SETTINGS, RESULTS)
    # Never counts as all 10,000: 3, 3 and 2; 2, 2 and 4.
    assert found["orders_q"].value == pytest.approx(8 / 3)
    assert found["orders_prq"].value == pytest.approx(8 / 3)


def test_readings_by_hand():
    found = {tuple(cell.values()): numbers for cell, numbers in readings(SETTINGS, RESULTS)}
    assert len(found) == 2 * 2 * 2
    # BPR that never lasts counts as all 10,000 too: -1, 0 and -2.
    assert found["10 returns", LASTING, "PRQ in [0, 1]"]["orders_q"].value == pytest.approx(-1)
    assert found["exact", LASTING, "PRQ as paid"]["orders_prq"].value == pytest.approx(1)


def test_settings_that_limits_cannot_describe():
    with pytest.raises(InputError, match="rows must be odd"):
        claim_of("C4.4").settings("quick", {"rows": 6})
