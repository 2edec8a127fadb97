"""The benchmark of buildings at a small size."""

import pytest

from benchmarks import buildings
from lifelore.core.errors import LifeloreError
from tests.benchmarks.contract import checked


def test_buildings_are_lived_in(monkeypatch):
    monkeypatch.setattr(buildings, "SIZES", ((14.0, 12.0, 0.6),))
    monkeypatch.setattr(buildings, "TASKS", 2)
    told = []
    result = buildings.bench_buildings(1, lambda *at: told.append(at))
    rows = checked(result, told)
    places = int(told[0][2].split()[0])
    assert places > 20
    later = rows[f"later task, {places} places"]
    assert later["ratio"] == pytest.approx(later["value"] / rows[f"first task, {places} places"]["value"])
    assert result["goals"][-1]["measured"] > 20


def test_a_life_that_fails_is_no_measurement():
    with pytest.raises(LifeloreError, match="a timed process must end well"):
        buildings.life_in((1.0, 1.0, 0.5))
