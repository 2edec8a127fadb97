"""The benchmark of memory: bytes by hand, files as filled, true merges, and the contract of its answer."""

import numpy as np
import pytest

from benchmarks import memory as case
from benchmarks.memory import ACTIONS, COUNTED, KEY, STEP, bench_memory, fill, probe
from lifelore.action.priors.action_prior import KIND, VERSION, ActionPrior
from lifelore.core.errors import LifeloreError
from lifelore.memory import open_memory
from tests.benchmarks.contract import checked


@pytest.fixture
def small(monkeypatch):
    """Few robots with few tasks."""
    for name, value in {"ROBOTS": 3, "TASKS": 4, "PRIOR_SLOTS": 5, "TRANSITIONS": 40, "FIRST_TASK": 30}.items():
        monkeypatch.setattr(case, name, value)


def test_the_answer_keeps_its_contract(monkeypatch, small):
    monkeypatch.setattr(case, "LEARNERS", (1, 3))
    monkeypatch.setattr(case, "CONTEXTS", (500, 2000))
    told = []
    result = bench_memory(1, lambda *at: told.append(at))
    rows = checked(result, told)
    assert len(rows) == 3 + 3 + 2 * 8 + 1 + 3
    assert all(line["value"] > 0 for line in rows.values())
    read, opened, merged = (goal["measured"] for goal in result["goals"])
    assert read == rows["2,000 contexts: read to open"]["value"]
    assert opened == pytest.approx(rows["2,000 contexts: open"]["value"] / 1e3)
    assert merged == rows[case.MANY]["value"]


def test_slopes_by_hand():
    assert case.slope_of({1: 100, 10: 7, 20: 27}) == 2.0


def test_every_context_of_a_file_has_its_counts(tmp_path):
    fill(tmp_path / "large.db", 100)
    with open_memory(tmp_path / "large.db") as memory:
        prior = ActionPrior.from_record(memory.recall(KIND, KEY, VERSION), ACTIONS)
        assert memory.check() == []
    assert len(prior) == 100
    assert ((prior.counts(STEP * np.arange(100)) > 0).sum(axis=1) == COUNTED).all()


def test_probed_writes_are_stored(tmp_path):
    path = tmp_path / "large.db"
    fill(path, 2000)
    size = path.stat().st_size
    found = probe(path, 2000, whole=True)
    assert min(found.values()) >= 0
    # A small memory is read and checked as a whole.
    assert found["read_bytes"] >= size
    with open_memory(path) as memory:
        assert memory.tasks("robot") == case.READS
        assert memory.check() == []


def test_a_merge_that_brings_too_little_is_no_measurement(small, tmp_path):
    source = case.robot_memory(tmp_path / "r.db", 0)
    with pytest.raises(LifeloreError, match="must bring 8 contributions, got 4"):
        case.merge_seconds([source, source], many=True)
