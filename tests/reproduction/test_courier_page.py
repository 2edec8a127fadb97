"""docs/courier.md says what results/bench_courier.json holds."""

import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROWS = {row["name"]: row for row in json.loads((ROOT / "results" / "bench_courier.json").read_text())["rows"]}
PAGE = (ROOT / "docs" / "courier.md").read_text()
TABLE = re.findall(r"^\| `(\w+)` \| [^|]+ \| ([^|]+) \| ([^|]+) \| ([^|]+) \| (\d+) \|$", PAGE, flags=re.M)


LIDAR = {
    "Willow": "bench_lidar.json",
    "offices": "bench_lidar_offices.json",
}
SEEN, ENOUGH = "steps until the goal is seen", "steps to 80 %"
LIDAR_TABLE = re.findall(r"^\| (Willow|offices) \| (\d+) m \| (.+) \|$", PAGE, flags=re.M)


def numbers(text: str) -> list[float]:
    return [float(number.replace(",", "")) for number in re.findall(r"[\d,]*\d(?:\.\d+)?", text)]


@pytest.mark.parametrize(("agent", "steps", "ratio", "collisions", "capped"), TABLE)
def test_table(agent, steps, ratio, collisions, capped):
    row = ROWS[f"{agent} at home, steps to 80 %"]
    assert numbers(steps) == pytest.approx([row["value"], *row["ci95"]], abs=1)
    expected = [1.0] if agent == "scratch" else [row["ratio"], *row["ratio_ci95"]]
    assert numbers(ratio) == pytest.approx(expected, abs=0.001)
    assert numbers(collisions) == pytest.approx([ROWS[f"{agent} at home, collisions"]["value"]], abs=1)
    assert int(capped) == ROWS[f"{agent} at home, capped tasks of 200"]["value"]


def test_the_table_is_whole_and_the_visit_is_told():
    assert len(TABLE) == 7
    visit, arrival = (
        ROWS[f"lore {where}, steps to 80 %"] for where in ("in another building", "in the first task there")
    )
    assert f"steps {visit['ratio']:.2f} [{visit['ratio_ci95'][0]:.2f}, {visit['ratio_ci95'][1]:.2f}]" in PAGE
    assert f"steps {arrival['ratio']:.2f} [{arrival['ratio_ci95'][0]:.2f}, {arrival['ratio_ci95'][1]:.2f}]" in PAGE


@pytest.mark.parametrize(("building", "reach", "cells"), LIDAR_TABLE)
def test_the_table_of_the_lidar(building, reach, cells):
    result = json.loads((ROOT / "results" / LIDAR[building]).read_text())
    rows = {row["name"]: row for row in result["rows"]}
    found = [numbers(cell) for cell in cells.split("|")]
    at = f"{reach} m"
    for (scratch, lore, ratio), unit in ((found[:3], SEEN), (found[3:6], ENOUGH)):
        for cell, agent in ((scratch, "scratch"), (lore, "lore")):
            row = rows[f"{agent}, {at}, {unit}"]
            assert cell == pytest.approx([row["value"], *row["ci95"]], abs=0.51)
        row = rows[f"lore, {at}, {unit}"]
        assert ratio == pytest.approx([row["ratio"], *row["ratio_ci95"]], abs=0.0051)
    row = rows[f"rmax, {at}, {ENOUGH}"]
    assert found[6] == pytest.approx([row["ratio"], *row["ratio_ci95"]], abs=0.0051)
    # No agent collided and no task was capped.
    assert all(row["value"] == 0 for name, row in rows.items() if "capped" in name)
    assert all(goal["met"] for goal in result["goals"])


def test_the_table_of_the_lidar_is_whole():
    assert [(building, int(reach)) for building, reach, _ in LIDAR_TABLE] == [
        (building, reach) for building in LIDAR for reach in (2, 5, 10)
    ]
    rows = {row["name"]: row for row in json.loads((ROOT / "results" / LIDAR["Willow"]).read_text())["rows"]}
    assert f"needs {rows['scratch, 5 m, steps to 80 %']['value']:,.0f} steps on Willow" in PAGE
