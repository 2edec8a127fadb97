"""The benchmark of recurring destinations, small; and the page that cites it."""

import json
import re
from pathlib import Path

import pytest

from benchmarks import bench
from benchmarks.lives import destinations
from lifelore.domains.worlds import make_world

ROOT = Path(__file__).parents[2]
ROWS = {row["name"]: row for row in json.loads((ROOT / "results" / "bench_destinations.json").read_text())["rows"]}
PAGE = (ROOT / "docs" / "courier.md").read_text()
TABLE = re.findall(r"^\| (tour of [^|]+|policy reuse [^|]+|exact search, [^|]+) \| (.+) \|$", PAGE, flags=re.M)


def numbers(text: str) -> list[float]:
    return [float(number.replace(",", "")) for number in re.findall(r"[\d,]*\d(?:\.\d+)?", text)]


def test_remembered_destinations_are_found_sooner(monkeypatch):
    monkeypatch.setattr(destinations, "TASKS", 12)
    monkeypatch.setattr(destinations, "PLACES", 2)
    monkeypatch.setattr(destinations, "make_world", lambda *_, seed: make_world("lattice"))
    result = bench("destinations", repeats=1)
    by_name = {row["name"]: row["value"] for row in result["rows"]}
    for law in destinations.LAWS:
        anywhere = by_name[f"{destinations.NOTHING}, {law}"]
        for method in (*destinations.RULES, destinations.TOLD, destinations.BEST):
            assert 0 < by_name[f"{method}, {law}"] < anywhere / 2


def test_the_page_says_what_the_file_holds():
    assert [name for name, _ in TABLE] == list(destinations.METHODS)
    for name, cells in TABLE:
        found = [numbers(cell) for cell in cells.split("|")]
        for (steps, ratio), law in zip((found[:2], found[2:]), destinations.LAWS, strict=True):
            row = ROWS[f"{name}, {law}"]
            assert steps == pytest.approx([row["value"], *row["ci95"]], abs=0.51)
            expected = [1.0] if name == destinations.BEST else [row["ratio"], *row["ratio_ci95"]]
            assert ratio == pytest.approx(expected, abs=0.0051)
