"""`bench factory`: the contract of its answer, and that both ways solve the same task."""

import json

import numpy as np
import pytest

from benchmarks import BENCHES
from benchmarks.action import factory
from benchmarks.action.factory import bench_factory, megabytes_of_all
from lifelore.core.errors import LifeloreError


def test_the_answer_keeps_its_contract(monkeypatch):
    monkeypatch.setattr(factory, "COMPONENTS", 2)
    monkeypatch.setattr(factory, "megabytes_of_all", lambda episodes: float(episodes))
    told = []
    result = bench_factory(3, lambda *at: told.append(at), episodes=7)
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    assert [(done, of) for done, of, _ in told] == [(i + 1, 13) for i in range(13)]
    rows = {line["name"]: line for line in result["rows"]}
    assert len(rows) == 5
    assert [line["ratio_to"] for line in result["rows"]] == [None, None, factory.TABLES, factory.SOLVE, None]
    assert all(line["value"] > 0 for line in result["rows"])
    assert [goal["measured"] for goal in result["goals"]] == [
        rows[name]["value"] for name in (factory.TABLES, factory.SOLVE, factory.ROOM)
    ]
    assert rows[factory.ROOM]["value"] == 7
    assert "factory" in BENCHES


def test_more_components_take_more_room():
    # Hundreds of configurations are met, each of 280 places and six actions: an action value and a table take 21
    # bytes, so 35 kB a configuration; one component has three.
    assert megabytes_of_all(3, components=1) + 5 < megabytes_of_all(40) < 300


def test_unlike_values_are_refused(monkeypatch):
    monkeypatch.setattr(factory, "COMPONENTS", 1)
    monkeypatch.setattr(factory, "optimal_q", lambda tables, discount: np.zeros(tables.next_state.shape[:2]))
    with pytest.raises(LifeloreError, match="both ways must find the same values"):
        bench_factory(1, lambda *at: None)
