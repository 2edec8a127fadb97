"""O2: the AUC by hand, and measures of made-up libraries."""

import numpy as np
import pytest

from reproduction.own.o_02_strangers.run import CELLS, HELD, KNOWN, auc, cells, readings


def test_auc_against_all_pairs():
    generator = np.random.default_rng(0)
    known, unseen = generator.integers(6, size=40).astype(float), generator.integers(2, 8, size=30).astype(float)
    pairs = unseen[:, None] - known
    assert auc(known, unseen) == pytest.approx(np.mean(pairs > 0) + np.mean(pairs == 0) / 2)
    assert auc(np.zeros(3), np.ones(2)) == 1
    assert auc(np.ones(3), np.ones(2)) == 0.5


def made(models, false, found):
    numbers = {"alarms": [0.0, found], "delay": 9.0, "auc": 0.9, "auc_of_entropy": 0.6}
    return {"models": models, "found": {KNOWN: {"alarms": [0.0, false]}, HELD: numbers, CELLS: numbers}}


def test_measures_by_hand():
    settings = {"models": ["exact", "10 runs, Gaussian"], "libraries": 2}
    results = [made("exact", 0.04, 0.8), made("exact", 0.06, 0.6), made("10 runs, Gaussian", 0.1, 0.5)]
    assert len(cells(settings)) == 4
    found = list(readings(settings, results))
    assert [tuple(cell.values()) for cell, _ in found][:2] == [("exact", HELD), ("exact", CELLS)]
    exact, learnt = found[0][1], found[2][1]
    assert (exact["false_alarms"].value, learnt["false_alarms"].value) == (pytest.approx(0.05), 0.1)
    assert exact["power"].value == pytest.approx(0.7)
    assert exact["auc_above_entropy"].value == pytest.approx(0.3)
