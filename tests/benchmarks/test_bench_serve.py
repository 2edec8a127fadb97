"""`bench serve` and `bench soak` at a small size: rows, goals, and the processes are gone afterwards."""

import os
import re
from pathlib import Path

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")

from benchmarks import bench
from benchmarks.service import serve, soak


def test_the_service_is_measured_beside_the_bare_route(monkeypatch):
    monkeypatch.setattr(serve, "SECONDS", 0.3)
    monkeypatch.setattr(serve, "BATCH", 50)
    monkeypatch.setattr(serve, "CONNECTIONS", 3)
    before, cores = children(), os.sched_getaffinity(0)
    document = bench("serve", repeats=1)
    assert [row["unit"] for row in document["rows"]] == [
        "pairs/s",
        "pairs/s",
        "ms",
        "decisions/s",
        "ms",
        "ms",
        "µs",
    ]
    assert all(row["value"] > 0 for row in document["rows"])
    assert document["rows"][1]["ratio"] == document["goals"][1]["measured"]
    assert len(document["goals"]) == 5
    assert (children(), os.sched_getaffinity(0)) == (before, cores)


def test_a_soak_tells_growth_beside_an_empty_store(monkeypatch):
    monkeypatch.setattr(soak, "SECONDS", 0.3)
    monkeypatch.setattr(soak, "USERS_A_MINUTE", 1500)
    before = children()
    steps: list[tuple[int, int, str]] = []
    document = bench("soak", repeats=1, progress=lambda *step: steps.append(step))
    rows = {row["name"]: row for row in document["rows"]}
    assert rows["users in the store"]["value"] == 1500
    assert rows["processor time of a pair"]["ratio"] == document["goals"][1]["measured"] > 0
    assert rows["file, a user"]["value"] > 100
    assert steps[-1][0] == steps[-1][1]
    assert children() == before


def test_growth_is_the_slope_of_megabytes_over_minutes(monkeypatch):
    monkeypatch.setattr(soak, "SECONDS", 30.0)
    assert soak._slope([10.0, 11.0, 12.0, 13.0]) == pytest.approx(2.0)


def children() -> int:
    """Number of processes that this process has started and that have not ended."""
    found = 0
    for status in Path("/proc").glob("[0-9]*/status"):
        try:
            found += re.search(rf"^PPid:\s+{os.getpid()}$", status.read_text(), re.MULTILINE) is not None
        except OSError:
            continue  # it ended just now
    return found
