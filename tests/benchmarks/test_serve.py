"""The benchmark of the service at a small size: rows, goals, and the processes are gone afterwards."""

import os
import re
from pathlib import Path

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")

from benchmarks import bench, serve


def test_the_service_is_measured_beside_the_bare_route(monkeypatch):
    monkeypatch.setattr(serve, "SECONDS", 0.3)
    monkeypatch.setattr(serve, "BATCH", 50)
    monkeypatch.setattr(serve, "MANY", 10_000)
    monkeypatch.setattr(serve, "CONNECTIONS", 3)
    before, cores = children(), os.sched_getaffinity(0)
    document = bench("serve", repeats=1)
    units = [row["unit"] for row in document["rows"]]
    assert units == [*["pairs/s"] * 4, *["ms"] * 4, "decisions/s", "µs", "s", "ms"]
    assert all(row["value"] > 0 for row in document["rows"])
    assert document["rows"][3]["ratio"] == document["goals"][1]["measured"]
    assert len(document["goals"]) == 7
    assert (children(), os.sched_getaffinity(0)) == (before, cores)


def children() -> int:
    """Number of processes that this process has started and that have not ended."""
    found = 0
    for status in Path("/proc").glob("[0-9]*/status"):
        try:
            found += re.search(rf"^PPid:\s+{os.getpid()}$", status.read_text(), re.MULTILINE) is not None
        except OSError:
            continue  # it ended just now
    return found
