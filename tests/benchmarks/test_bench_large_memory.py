"""`bench large_memory`: what is filled, what a new process measures, and the contract of the answer."""

import json

import numpy as np
from PIL import Image

from benchmarks.fleet import large_memory
from benchmarks.fleet.large_memory_case import ACTIONS, KEY, STEP, fill, probe, probed
from lifelore.action.priors.action_prior import KIND, VERSION, ActionPrior
from lifelore.memory import open_memory, sqlite_file


def test_every_context_has_its_counts(tmp_path):
    fill(tmp_path / "large.db", 100, counted=3)
    with open_memory(tmp_path / "large.db") as memory:
        prior = ActionPrior.from_record(memory.recall(KIND, KEY, VERSION), ACTIONS)
        assert memory.check() == []
    assert len(prior) == 100
    counts = prior.counts(STEP * np.arange(100))
    assert ((counts > 0).sum(axis=1) == 3).all()


def test_a_new_process_measures_and_its_writes_are_stored(tmp_path):
    path = tmp_path / "large.db"
    fill(path, 2000)
    size = path.stat().st_size
    found = probed(path, 2000, whole=True)
    assert all(value > 0 for value in found.values())
    # A small memory is read and checked as a whole.
    assert found["read_bytes"] >= size
    assert "load" not in probed(path, 2000, whole=False)
    with open_memory(path) as memory:
        assert memory.tasks("robot") == 2 * 50
        assert memory.check() == []


def test_opening_a_large_memory_does_not_read_it(tmp_path, monkeypatch):
    path = tmp_path / "large.db"
    fill(path, 20_000)
    size = path.stat().st_size
    monkeypatch.setattr(sqlite_file, "CHECKED_BYTES", size - 1)
    assert probe(path, 20_000, whole=False)["read_bytes"] < size / 5


def test_the_answer_keeps_its_contract(monkeypatch, tmp_path):
    monkeypatch.setattr(large_memory, "CONTEXTS", (500, 2000))
    monkeypatch.setattr(large_memory, "SLOPE_CONTEXTS", 1000)
    monkeypatch.setattr(large_memory, "LEAST_REPEATS", 2)
    told = []
    result = large_memory.bench_large_memory(2, lambda *at: told.append(at), tmp_path)
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    assert [(done, of) for done, of, _ in told] == [(i + 1, 9) for i in range(9)]
    assert set(result["contexts"]) == {"500", "2000"}
    names = [line["name"] for line in result["rows"]]
    assert len(names) == len(set(names)) == 2 * 9 + 4
    read, opened = result["goals"]
    assert read["measured"] * 1e6 == result["contexts"]["2000"]["read_bytes"]
    assert opened["measured"] == result["contexts"]["2000"]["open"]
    with Image.open(tmp_path / "bench_large_memory.png") as picture:
        assert min(picture.size) > 300
