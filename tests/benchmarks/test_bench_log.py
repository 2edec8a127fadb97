"""The benchmark of a long log, small: the log has its lines, and rows and goal follow from the times."""

import csv
import json
from collections import Counter
from pathlib import Path

import pytest

from benchmarks import bench
from benchmarks.interaction import log


def test_the_log_has_its_lines_and_users(tmp_path):
    log.write_log(tmp_path / "log.csv", 600)
    with (tmp_path / "log.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 600
    assert set(Counter(row["user"] for row in rows).values()) == {log.LINES_PER_USER}
    assert {row["policy"] for row in rows} == {f"p{policy}" for policy in range(log.POLICIES)}


def test_rows_and_goal(monkeypatch):
    monkeypatch.setattr(log, "LINES", (600, 1200))
    ticks = []
    document = bench("log", repeats=2, progress=lambda *at: ticks.append(at[:2]))
    assert ticks == [(done, 4) for done in (1, 2, 3, 4)]
    short, long = document["rows"]
    assert (short["unit"], long["ratio_to"]) == ("s", "fit of 600 lines")
    assert short["value"] > 0
    (goal,) = document["goals"]
    assert (goal["goal"], goal["met"]) == ("<= 30.0", True)
    assert goal["measured"] == pytest.approx(long["value"])


def test_the_pages_time_is_the_results():
    root = Path(__file__).parents[2]
    (goal,) = json.loads((root / "results" / "bench_log.json").read_text(encoding="utf-8"))["goals"]
    page = " ".join((root / "docs" / "policy_reuse.md").read_text(encoding="utf-8").split())
    assert f"{goal['measured']:.0f} s for a generated log" in page
