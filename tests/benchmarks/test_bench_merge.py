"""The benchmark of merging: small, by its contract, on true work."""

import json

import pytest

from benchmarks import bench
from benchmarks.fleet import merge
from lifelore.core.errors import LifeloreError
from lifelore.memory import open_memory


@pytest.fixture
def small(monkeypatch):
    for name, value in {"ROBOTS": 3, "TASKS": 4, "PRIOR_SLOTS": 5, "TRANSITIONS": 40, "FIRST_TASK": 30}.items():
        monkeypatch.setattr(merge, name, value)


def test_rows_and_goals(small):
    told = []
    result = bench("merge", repeats=2, progress=lambda *at: told.append(at))
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    assert [(done, of) for done, of, _ in told] == [(i + 1, 9) for i in range(9)]
    for line in result["rows"]:
        assert list(line) == ["name", "value", "unit", "ratio_to", "ratio"]
        assert line["value"] > 0
        assert line["ratio_to"] in (None, result["rows"][0]["name"])
    (goal,) = result["goals"]
    assert goal == {
        "name": "seconds, many in one call", "goal": "<= 3.0", "measured": result["rows"][0]["value"], "met": True,
    }  # fmt: skip


def test_a_robot_meets_every_transition_once(small, tmp_path):
    with open_memory(merge.robot_memory(tmp_path / "r.db", 0)) as memory:
        assert memory.tasks("robot 0") == 4
        assert memory.recall("transitions", "building", 1).slots.tolist() == list(range(40))
        assert memory.check() == []


def test_a_merge_that_brings_too_little_is_no_measurement(small, tmp_path):
    source = merge.robot_memory(tmp_path / "r.db", 0)
    with pytest.raises(LifeloreError, match="must bring 8 contributions, got 4"):
        merge.merge_seconds([source, source], many=True)
