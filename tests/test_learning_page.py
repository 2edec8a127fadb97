"""The table of thirteen worlds says what the stored result of claim O3 holds."""

import json
import re
from pathlib import Path

import pytest

from reproduction.own.o_03_your_worlds.run import numbers

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "start" / "learning.md").read_text(encoding="utf-8")
RESULT = json.loads((ROOT / "reproduction" / "results" / "O3" / "result.json").read_text(encoding="utf-8"))
TABLE = [line.strip("| ").split(" | ") for line in PAGE.splitlines() if line.startswith("| ")][1:]
GAINS = ("all_over_textbook", "all_over_scratch")


def plain(text: str) -> list[float]:
    return [float(found.replace("−", "-")) for found in re.findall(r"[+−]?\d+\.\d+", text)]


def test_each_world_has_its_row():
    assert [row[0] for row in TABLE] == RESULT["settings"]["worlds"]


@pytest.mark.parametrize("row", TABLE, ids=lambda row: row[0])
def test_a_row_is_the_stored_result(row):
    world, *cells = row
    found = numbers(RESULT["rows"], world)
    digits = len(re.findall(r"\.(\d+)", cells[0])[0])
    for name, cell in zip(GAINS, cells, strict=True):
        low, high = found[name].ci95 or (found[name].value,) * 2
        assert plain(cell) == pytest.approx([found[name].value, low, high], abs=0.51 * 10**-digits)
        assert cell.startswith("**") == (low > 0 or high < 0)


def test_the_sentences_count_as_the_table_does():
    above = {"all_over_textbook": 0, "last_over_textbook": 0}
    for world in RESULT["settings"]["worlds"]:
        found = numbers(RESULT["rows"], world)
        for name in above:
            low, high = found[name].ci95 or (0.0, 0.0)
            above[name] += low > 0
            assert high >= 0, f"{world} is certainly below the textbook"
    assert list(above.values()) == [10, 8]
    assert "certainly above the textbook in ten worlds, in the last tenth in eight" in " ".join(PAGE.split())
