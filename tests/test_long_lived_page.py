"""docs/long_lived.md holds the numbers of results/bench_long_lived_worlds.json and bench_tabletop_lives.json."""

import json
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "long_lived.md").read_text(encoding="utf-8").splitlines()
RESULT = json.loads((ROOT / "results" / "bench_long_lived_worlds.json").read_text(encoding="utf-8"))
ROWS = {row["name"]: row for row in RESULT["rows"]}
WORLDS = ("factory", "office", "mapped building")
CHANGING = "factory that changes"
SPANS = ("before the late type", "after its arrival", "after the change")


def shown(row, value="value", interval="ci95", digits=1):
    """A number and its interval as the page has them."""
    found = f"{row[value]:.{digits}f}"
    return found + (f" [{row[interval][0]:.{digits}f}, {row[interval][1]:.{digits}f}]" if row[interval] else "")


def agents_in(world):
    """Agents with rows in the second half of a world."""
    start = f"{world}, second half: "
    names = [name.removeprefix(start) for name in ROWS if name.startswith(start)]
    return [name for name in names if not name.endswith("more than full") and name != "best possible return"]


def line_of_halves(world, agent):
    first, second = (ROWS[f"{world}, {half} half: {agent}"] for half in ("first", "second"))
    ratio = shown(second, "ratio", "ratio_ci95", 2) if agent != "scratch" else "1"
    more = shown(ROWS[f"{world}, second half: {agent}, more than full"]) if agent != "full" else "–"
    return f"| {world} | {agent} | {shown(first)} | {shown(second)} | {ratio} | {more} |"


def line_of_changes(agent):
    cells = [shown(ROWS[f"{CHANGING}, {span}: {agent}"]) for span in SPANS]
    return f"| {agent} | " + " | ".join(cells) + " |"


@pytest.mark.parametrize(("world", "agent"), [(world, agent) for world in WORLDS for agent in agents_in(world)])
def test_the_table_of_worlds(world, agent):
    assert line_of_halves(world, agent) in PAGE


@pytest.mark.parametrize("agent", ["full", "no-prior", "scratch"])
def test_the_table_of_changes(agent):
    assert line_of_changes(agent) in PAGE


def test_the_late_type():
    noticed, before = (
        ROWS[f"{CHANGING}: {name}"]["value"]
        for name in ("alarm at the first task of the late type", "alarms in the quarter before")
    )
    assert f"Alarm at the late type's first task: {noticed:.0%}; alarms in the tasks before: {before:.0%}." in PAGE


TABLETOP = {
    row["name"]: row
    for row in json.loads((ROOT / "results" / "bench_tabletop_lives.json").read_text(encoding="utf-8"))["rows"]
}


@pytest.mark.parametrize("agent", [name.partition(":")[0] for name in TABLETOP if "last episodes" in name])
def test_the_table_of_tabletop_lives(agent):
    parts = (
        "first episodes of the first forty tasks",
        "first episodes on new trays",
        "last episodes on new trays",
    )
    cells = [TABLETOP[f"{agent}: {part}"] for part in (*parts, "spills in first episodes on new trays")]
    if agent != "full":
        cells.append(TABLETOP[f"full less {agent}: first episodes on new trays"])
    line = " | ".join([agent, *(shown(cell, digits=2) for cell in cells), *(["–"] if agent == "full" else [])])
    assert f"| {line} |" in PAGE
