"""docs/courier.md says what results/bench_courier.json holds."""

import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROWS = {row["name"]: row for row in json.loads((ROOT / "results" / "bench_courier.json").read_text())["rows"]}
PAGE = (ROOT / "docs" / "courier.md").read_text()
TABLE = re.findall(r"^\| `(\w+)` \| [^|]+ \| ([^|]+) \| ([^|]+) \| ([^|]+) \| (\d+) \|$", PAGE, flags=re.M)


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
