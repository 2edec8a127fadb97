"""The benchmark of models of ordered categories, small: the loss by hand, and the order of the models."""

import numpy as np
import pytest

from benchmarks import bench
from benchmarks.interaction import bands
from lifelore.domains.golf.golf import Golf
from lifelore.interaction.signals.category_signal import CategorySignal


def test_the_loss_is_the_divergence_from_the_true_probabilities():
    true = Golf().category_probs
    assert bands.loss(CategorySignal(true)) == 0.0
    even = CategorySignal(np.full(true.shape, 1 / 7))
    entropy = -(true * np.log(np.where(true > 0, true, 1.0))).sum(axis=2).mean()
    assert bands.loss(even) == pytest.approx(np.log(7) - entropy)


def test_rows_and_goals(monkeypatch):
    monkeypatch.setattr(bands, "RUNS", (1, 3))
    document = bench("bands", repeats=3)
    rows = {row["name"]: row for row in document["rows"]}
    assert len(rows) == 8
    usual, normal = (rows[f"{name}, 3 runs a pair"] for name in (bands.USUAL, bands.NORMAL))
    assert normal["ratio"] == pytest.approx(normal["value"] / usual["value"])
    assert normal["ratio_to"] == usual["name"]
    assert (usual["ratio"], usual["n"]) == (None, 3)
    assert [goal["met"] for goal in document["goals"]][1]
    assert document["goals"][1]["measured"] == pytest.approx(normal["ratio"])
