"""`bench capacity`: bounds and slopes by hand, what is counted and measured, and the contract of its answer."""

import json

import numpy as np
import pytest
from PIL import Image

from benchmarks import bench
from benchmarks.fleet import capacity, capacity_case
from benchmarks.fleet.capacity_case import (
    ACTIONS,
    TURN,
    Contexts,
    Learners,
    bytes_of,
    contributions,
)
from benchmarks.fleet.gpu_bound import MOVE_COPIED, SAMPLE_BYTES, SAMPLE_COPIED, Gpu
from lifelore.core.errors import InputError
from lifelore.core.learning.curve import TOTAL

ROUND = Gpu(bandwidth=160e9, transfer=1e9, latency=1e-6, launch=1e-3)
"""160 bytes a step: 1e9 steps a second at most. Two reads in a row: 0.5e6 of them by one thread."""


def test_a_gpus_steps_by_hand():
    assert ROUND.most_steps(1) == pytest.approx(0.5e6)
    assert ROUND.most_steps(100) == pytest.approx(50e6)
    assert ROUND.most_steps(1e6) == pytest.approx(1e9)
    # 1e6 learners of 1 kB for 10 steps each: 10 ms of steps, 2 ms of launches, 2 s of copying.
    assert ROUND.most_steps_with_copies(1e6, 1000, 10) == pytest.approx(1e7 / 2.012)


def test_where_a_gpu_gets_ahead_by_hand():
    assert ROUND.learners_to_beat(10e6) == pytest.approx(20)
    assert ROUND.most_steps(20) == pytest.approx(10e6)
    assert ROUND.learners_to_beat(2e9) is None
    # A step of all costs the processor 0.1 s and the GPU 1 ms; copying and launches cost 2.002 s.
    steps = ROUND.steps_to_beat(10e6, 1e6, 1000)
    assert steps == pytest.approx(2.002 / 0.099)
    assert ROUND.most_steps_with_copies(1e6, 1000, steps) == pytest.approx(10e6)
    assert ROUND.steps_to_beat(10e6, 10, 1000) is None


def test_a_gpus_samples_and_moves_by_hand():
    assert ROUND.most_samples() == pytest.approx(1 / (SAMPLE_BYTES / 160e9 + SAMPLE_COPIED / 1e9))
    # 1 µs a sample here, 25.1 ns there and 1 ms for the launch.
    assert ROUND.samples_to_beat(1e6) == pytest.approx(1e-3 / (1e-6 - 25.1e-9))
    assert ROUND.samples_to_beat(1e9) is None
    assert ROUND.most_moves() * MOVE_COPIED == pytest.approx(1e9)


def test_an_assumption_must_be_positive():
    with pytest.raises(InputError, match="latency must be positive, got 0"):
        Gpu(latency=0)


def test_slopes_by_hand():
    assert capacity.slope_of({1: 100, 10: 7, 20: 27}) == 2.0
    slope, planned = capacity._planned("x", 1000, "w", {10: 7e3, 20: 27e3}, (1e3, "kB"), (1e6, "MB"))
    assert (slope["name"], slope["value"], slope["unit"]) == ("a x more: w", 2.0, "kB")
    assert (planned["value"], planned["ratio_to"], planned["ratio"]) == (2.0, slope["name"], 1.0)
    assert "(extrapolated)" in planned["name"]
    assert capacity._planned("x", 20, "w", {10: 7e3, 20: 27e3}, (1e3, "kB"), (1e6, "MB")) == [slope]


def test_bytes_are_those_that_stay():
    bytes_of(lambda: np.zeros(1))
    made, size = bytes_of(lambda: np.zeros(10**6) + np.ones(10**6))
    assert made.sum() == 10**6
    assert 8e6 <= size < 8.1e6


def test_learners_take_turns_and_learn():
    many = Learners(3)
    assert many.advance() == many.advance() == 3 * TURN
    assert many.learners.cursor[:, TOTAL].tolist() == [2 * TURN] * 3
    tables = many.learners.q
    assert all(table.any() for table in tables)
    assert not np.array_equal(tables[0], tables[1])


def test_contexts_are_all_counted(monkeypatch):
    monkeypatch.setattr(capacity_case, "LEAST_CONTEXTS", 4000)
    contexts = Contexts(2000)
    assert len(contexts.prior) == 2000
    assert contexts.bytes == pytest.approx(2000 * (8 + 8 * ACTIONS), rel=0.1)
    before = contexts.prior.counts(contexts.codes)
    assert before.sum() == contexts.best.sum()
    assert contexts.updates() > 0
    assert np.array_equal(contexts.prior.counts(contexts.codes), 3 * before)
    assert contexts.samples() > 0


def test_a_memory_grows_by_its_contributions():
    found = contributions([8, 3])
    assert list(found) == [3, 8]
    assert 0 < found[3]["bytes"] <= found[8]["bytes"]
    assert found[8]["seconds_of_all"] == pytest.approx(3 * found[3]["seconds"] + 5 * found[8]["seconds"])


def test_the_answer_keeps_its_contract(monkeypatch, tmp_path):
    for name, small in (("LEARNERS", (1, 3)), ("CONTEXTS", (500, 2000)), ("CONTRIBUTIONS", (2, 6))):
        monkeypatch.setattr(capacity, name, small)
    monkeypatch.setattr(capacity, "MANY_CONTEXTS", 2000)
    for name, small in (("LEAST_STEPS", 3000), ("LEAST_CONTEXTS", 2000), ("LARGE", 41)):
        monkeypatch.setattr(capacity_case, name, small)
    monkeypatch.setattr(capacity, "LEAST_REPEATS", 2)
    monkeypatch.chdir(tmp_path)
    told = []
    result = bench("capacity", repeats=1, progress=lambda *at: told.append(at))
    assert list(tmp_path.iterdir()) == []
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    assert [(done, of) for done, of, _ in told] == [(i + 1, 6) for i in range(6)]
    rows = {line["name"]: line for line in result["rows"]}
    assert len(rows) == len(result["rows"])
    for line in rows.values():
        assert (line["ratio"] is None) == (line["ratio_to"] is None)
        if line["ratio_to"]:
            assert line["value"] == pytest.approx(line["ratio"] * rows[line["ratio_to"]]["value"])
    extrapolated = [name for name in rows if "(extrapolated)" in name]
    assert [name.split(",")[0] for name in extrapolated] == ["Q-learners"] * 2 + ["contributions"] * 2
    assert set(result["learners"]) == {"1", "3"}
    assert result["assumptions"] == Gpu().to_dict()
    with_figure = capacity.bench_capacity(2, lambda *at: None, tmp_path)
    assert with_figure["rows"][0]["name"] == "Q-learners, 1: memory"
    path = tmp_path / "bench_capacity.png"
    assert path.stat().st_size <= 300_000
    with Image.open(path) as picture:
        assert min(picture.size) > 300
