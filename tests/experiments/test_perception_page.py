"""docs/perception.md says what the benchmarks under results/ hold."""

import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "perception.md").read_text(encoding="utf-8")
METHODS = re.findall(r"^\| (?!method)([a-z][^|]+?) \| (0\.\d{3} \[.+)\|$", PAGE, flags=re.M)
COLUMNS = (
    ("simulated", "exact"),
    ("simulated", "on"),
    ("simulated", "macro F1"),
    ("real", "exact"),
    ("real", "on"),
    ("real, learnt from the others too", "exact"),
)


def bench(name: str) -> dict:
    return json.loads((ROOT / "results" / f"bench_{name}.json").read_text(encoding="utf-8"))


def rows(name: str) -> dict[str, dict]:
    return {row["name"]: row for row in bench(name)["rows"]}


@pytest.mark.parametrize(("method", "cells"), METHODS, ids=[method for method, _ in METHODS])
def test_relations(method, cells):
    found = rows("relations")
    for cell, (where, measure) in zip(cells.split("|"), COLUMNS, strict=True):
        if cell.strip():
            row = found[f"{method}, {where}, {measure}"]
            value, *ends = map(float, re.findall(r"\d\.\d+", cell))
            assert value == pytest.approx(row["value"], abs=6e-4)
            assert not ends or ends == pytest.approx(row["ci95"], abs=6e-3)


def test_plans():
    found = rows("plans")
    table = re.findall(r"^\| (0[.\d]*)(?: \(default\))? \| (0\.\d{3} \|.+) \|$", PAGE, flags=re.M)
    assert len(table) == 5
    for least, cells in table:
        names = [
            f"{where}, hidden tops unknown, from {float(least):g}: {measure}"
            for where in ("simulated", "real")
            for measure in ("objects with a plan", "valid plans")
        ]
        for name, cell in zip(names, cells.split("|"), strict=True):
            value, *ends = map(float, re.findall(r"\d\.\d+", cell))
            assert value == pytest.approx(found[name]["value"], abs=6e-4)
            assert not ends or ends == pytest.approx(found[name]["ci95"], abs=6e-3)


def test_everybody_is_in_the_table():
    told = {name.split(",")[0] for name in rows("relations") if name.endswith(", real, exact")}
    # Ours are shown with the logic that goes with them alone.
    assert {method for method, _ in METHODS} == told - {"ours", "ours as shipped"}


def test_what_the_goals_measured_is_told():
    told = {
        "perceive": ("0.34 s (goal 0.4)", "0.52 s (goal 0.4: **missed**)", "1.7 s (goal 3)"),
        "separator": ("6.4, 18.8, 52 times", "17.8, 54, 129 times", "4.0 and 3.6 ms", "3.0 and 0.24 s"),
    }
    for name, words in told.items():
        assert all(text in PAGE for text in words)
        measured = [goal["measured"] for goal in bench(name)["goals"]]
        for text in words:
            for number in re.findall(r"\d+(?:\.\d+)?", text.split("(")[0]):
                decimals = len(number.partition(".")[2])
                assert any(f"{value:.{decimals}f}" == number for value in measured), number
