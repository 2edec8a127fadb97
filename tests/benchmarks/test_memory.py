"""The benchmark of memory: bytes by hand, files as filled, true merges, and the contract of its answer."""

import numpy as np
import pytest

from benchmarks import memory as case
from benchmarks.memory import ACTIONS, COUNTED, KEY, STEP, bench_memory, fill
from lifelore.action.priors.action_prior import KIND, VERSION, ActionPrior
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


def test_every_context_of_a_file_has_its_counts(tmp_path):
    fill(tmp_path / "large.db", 100)
    with open_memory(tmp_path / "large.db") as memory:
        prior = ActionPrior.from_record(memory.recall(KIND, KEY, VERSION), ACTIONS)
        assert memory.check() == []
    assert len(prior) == 100
    assert ((prior.counts(STEP * np.arange(100)) > 0).sum(axis=1) == COUNTED).all()
