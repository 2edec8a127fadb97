"""Benchmarks: the contract of their answer, like work by all, and what happens without gcc."""

import json
from pathlib import Path

import numpy as np
import pytest

from benchmarks import BENCHES, bench
from benchmarks.learners import c_loop, kernels
from benchmarks.learners.gymnasium_loop import TextbookLattice, short_textbook_rate, textbook_rate
from benchmarks.learners.lattice_case import lattice_task, new_case, run_kernel
from benchmarks.learners.list_loop import short_tuned_rate, tuned_rate
from benchmarks.learners.many_learners import alone_rate, many_rate
from benchmarks.learners.thread_scaling import check_same_bits, run_all
from benchmarks.rounds import (
    at_least,
    at_most,
    estimated_row,
    interleaved,
    paired_ratio,
    row,
)
from benchmarks.startup import first_result
from lifelore.core.errors import InputError, LifeloreError, NotFoundError
from lifelore.core.metrics import Estimate

FOLDER = Path(c_loop.__file__).parents[1]


@pytest.fixture
def small(monkeypatch):
    """The whole benchmark at a size for tests; processes of their own are not started."""
    monkeypatch.setattr(kernels, "textbook_rate", lambda: textbook_rate(2000))
    monkeypatch.setattr(kernels, "short_textbook_rate", lambda: short_textbook_rate(2000))
    monkeypatch.setattr(kernels, "tuned_rate", lambda: tuned_rate(2000))
    monkeypatch.setattr(kernels, "short_tuned_rate", lambda: short_tuned_rate(2000))
    monkeypatch.setattr(kernels, "alone_rate", lambda n=2: alone_rate(2))
    monkeypatch.setattr(kernels, "many_rate", lambda threads: many_rate(threads, chunk=1000, learners=4))


def test_the_answer_keeps_its_contract(small):
    told = []
    result = bench("kernels", repeats=1, progress=lambda *at: told.append(at))
    assert list(result) == ["bench", "rows", "goals"]
    assert result["bench"] == "kernels"
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    for line in result["rows"]:
        assert list(line) == ["name", "value", "unit", "ratio_to", "ratio"]
    for goal in result["goals"]:
        assert list(goal) == ["name", "goal", "measured", "met"]
    names = [line["name"] for line in result["rows"]]
    assert len(set(names)) == len(names)
    assert all(line["ratio_to"] in [*names, None] for line in result["rows"])
    total = told[0][1]
    assert [(done, of) for done, of, _ in told] == [(i + 1, total) for i in range(total)]
    assert sum("learners" in goal["name"] for goal in result["goals"]) == 2


def test_goals_are_the_kernels_ratio_to_its_rivals(small):
    result = bench("kernels", repeats=1)
    values = {line["name"]: line["value"] for line in result["rows"]}
    for goal in result["goals"]:
        if goal["name"].startswith("kernel / ") and goal["measured"] is not None:
            expected = values["kernel"] / values[goal["name"].removeprefix("kernel / ")]
            assert goal["measured"] == pytest.approx(expected)
            assert goal["met"] == (expected >= float(goal["goal"].removeprefix(">= ")))


def test_without_gcc_its_goal_is_left_open(small, monkeypatch):
    monkeypatch.setattr(c_loop.shutil, "which", lambda name: None)
    result = bench("kernels", repeats=1)
    (goal,) = [goal for goal in result["goals"] if goal["name"].startswith("kernel / C")]
    assert (goal["measured"], goal["met"]) == (None, None)
    (line,) = [line for line in result["rows"] if line["name"].startswith("C ")]
    assert line["name"].endswith("not measured, no gcc found")
    assert (line["value"], line["ratio"]) == (None, None)


@pytest.mark.skipif(c_loop.shutil.which("gcc") is None, reason="gcc is not installed")
def test_the_c_twin_learns_the_same_bits():
    loop = c_loop.built_c_loop()
    assert loop is not None
    ours, theirs = new_case(300, seed=4), new_case(300, seed=4)
    assert run_kernel(ours) == loop.run(theirs) > 3000
    for a, b in zip((*ours.learner[:4], *ours.curve), (*theirs.learner[:4], *theirs.curve), strict=True):
        assert np.array_equal(a, b)
    assert theirs.learner.q.any()
    assert theirs.curve.collisions.any()


@pytest.mark.skipif(c_loop.shutil.which("gcc") is None, reason="gcc is not installed")
def test_a_twin_that_does_other_work_is_refused(tmp_path, monkeypatch):
    source = c_loop.SOURCE.read_text()
    other = tmp_path / "q_learning.c"
    other.write_text(source.replace("w.visits[row + a]++;", ""))
    monkeypatch.setattr(c_loop, "SOURCE", other)
    with pytest.raises(InputError, match="must give the kernel's bits"):
        c_loop.built_c_loop()
    other.write_text("not C")
    with pytest.raises(InputError, match=r"gcc must build q_learning\.c, got '.*error"):
        c_loop.built_c_loop()


def test_the_textbook_world_is_the_lattice():
    env, tables = TextbookLattice(), lattice_task().tables()
    assert len(env.cells) == tables.n_states == 341
    for s, cell in enumerate(env.cells):
        for a in range(4):
            env.cell = cell
            following, reward, terminated, truncated, _ = env.step(a)
            assert following == tables.next_state[s, a, 0]
            assert reward == tables.reward[s, a, 0]
            assert terminated == (tables.event[s, a, 0] == 1)
            assert not truncated


def test_threads_learn_the_same():
    check_same_bits()
    alone, together = ([new_case(40, seed) for seed in range(5)] for _ in range(2))
    assert run_all(alone, 1) == run_all(together, 3)
    assert all(np.array_equal(a.learner.q, b.learner.q) for a, b in zip(alone, together, strict=True))


def test_a_first_result_in_a_process_of_its_own(monkeypatch):
    timed, caches = first_result._timed_inside, []

    def watched(source, cache):
        caches.append((cache, any(Path(cache).rglob("*.nbc"))))
        return timed(source, cache)

    monkeypatch.setattr(first_result, "_timed_inside", watched)
    assert min(first_result.first_result_seconds("q")) > 0
    ((empty, before), (filled, after)) = caches
    assert (empty == filled, before, after) == (True, False, True)  # first nothing compiled, then what it left
    with pytest.raises(LifeloreError, match="a timed process must end well, got 'NameError"):
        first_result._timed_inside("nothing", ".")


def test_rounds_are_interleaved_and_turn_round():
    order = []
    rates = interleaved({"a": lambda: 1.0, "b": lambda: 2.0}, 3, order.append)
    assert order == ["a", "b", "b", "a", "a", "b"]
    assert rates == {"a": [1.0] * 3, "b": [2.0] * 3}


def test_ratios_are_paired():
    # 1/2, 4/4, 9/3: the median of pairs is 1, of medians it were 4/3.
    assert paired_ratio([1.0, 4.0, 9.0], [2.0, 4.0, 3.0]) == 1.0


def test_lines_by_hand():
    assert at_least("x", 2.0, 2.0) == {"name": "x", "goal": ">= 2.0", "measured": 2.0, "met": True}
    assert at_most("x", 2.0, 2.1)["met"] is False
    assert at_least("x", 2.0, None)["met"] is None


def test_a_row_from_an_estimate_has_interval_number_and_ratio():
    steps, ratio = Estimate(4.0, 3.5, (3.0, 5.0), 6), Estimate(0.5, 0.5, None, 6)
    alone = estimated_row("lore", steps, "steps")
    assert alone == row("lore", 4.0, "steps") | {"ci95": [3.0, 5.0], "n": 6}
    beside = {"ratio_to": "scratch", "ratio": 0.5, "ratio_ci95": None}
    assert estimated_row("lore", steps, "steps", "scratch", ratio) == alone | beside
    nothing = Estimate(float("nan"), float("nan"), None, 0)
    assert estimated_row("lore", nothing, "steps") == row("lore", None, "steps") | {"ci95": None, "n": 0}
    assert row("x", 1.0, "s") == {"name": "x", "value": 1.0, "unit": "s", "ratio_to": None, "ratio": None}


def test_what_cannot_be_run():
    with pytest.raises(NotFoundError, match=r"bench must be one of kernels, .*, got 'speed'"):
        bench("speed")
    for repeats in (0, 1001):
        with pytest.raises(InputError, match=rf"repeats must lie in \[1, 1000\], got {repeats}"):
            bench("kernels", repeats=repeats)
    assert "kernels" in BENCHES


def test_every_benchmark_stands_in_its_folder():
    for name, folder in BENCHES.items():
        source = FOLDER / folder / f"{name}.py"
        assert f"def bench_{name}(" in source.read_text(encoding="utf-8")


def test_courier_lives_at_home_and_abroad(monkeypatch):
    from benchmarks.lives import courier

    monkeypatch.setattr(courier, "TASKS", 3)
    monkeypatch.setattr(courier, "VISITS", 1)
    steps = []
    result = bench("courier", repeats=1, progress=lambda *step: steps.append(step))
    assert [step[:2] for step in steps] == [(1, 2), (2, 2)]
    by_name = {row["name"]: row for row in result["rows"]}
    lore = by_name["lore at home, steps to 80 %"]
    scratch = by_name[lore["ratio_to"]]
    assert lore["ratio"] == pytest.approx(lore["value"] / scratch["value"])
    assert (
        by_name["lore in another building, collisions"]["value"]
        < by_name["scratch in another building, collisions"]["value"]
    )
    assert len(result["goals"]) == 8


def test_lives_with_a_lidar_at_each_range(monkeypatch):
    from benchmarks.lives import lidar

    monkeypatch.setattr(lidar, "TASKS", 3)
    monkeypatch.setattr(lidar, "RANGES", (2.0, 6.0))
    result = bench("lidar", repeats=2)
    rows = {row["name"]: row for row in result["rows"]}
    assert len(rows) == 18
    for reach in (2, 6):
        seen, enough = (
            rows[f"lore, {reach} m, {unit}"] for unit in ("steps until the goal is seen", "steps to 80 %")
        )
        assert 0 <= seen["value"] <= enough["value"]
        scratch = rows[f"scratch, {reach} m, steps to 80 %"]["value"]
        assert enough["ratio"] == pytest.approx(enough["value"] / scratch)
        assert rows[f"lore, {reach} m, capped tasks of 2"]["value"] == 0
    collisions = [goal for goal in result["goals"] if goal["name"].startswith("collisions")]
    assert [goal["measured"] for goal in collisions] == [0, 0]


def test_a_map_is_for_the_courier():
    with pytest.raises(InputError, match="map applies to bench courier"):
        bench("kernels", map="x.yaml")
