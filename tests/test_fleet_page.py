"""docs/fleet.md shows the numbers of its results."""

import json
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "fleet.md").read_text(encoding="utf-8")


def result(name: str) -> dict:
    return json.loads((ROOT / "results" / f"bench_{name}.json").read_text(encoding="utf-8"))


def number(value: float) -> str:
    return f"{value:,.0f}" if value >= 100 else f"{value:.2g}" if value < 10 else f"{value:.0f}"


def customers_table() -> str:
    rows = {row["name"]: row for row in result("customer_fleet")["rows"]}
    lines = ["| robots | rounds to competence | of one robot | tasks of all |", "|---|---|---|---|"]
    for robots in (1, 2, 4, 8):
        own = rows[f"{robots} robots: rounds to competence"]
        low, high = own["ci95"]
        lines.append(
            f"| {robots} | {own['value']:.1f} [{low:.1f}, {high:.1f}] | {own['ratio']:.2f}"
            f" | {rows[f'{robots} robots: tasks of all until then']['value']:.1f} |"
        )
    return "\n".join(lines)


def fleet_table() -> str:
    rows = {row["name"]: row for row in result("fleet")["rows"]}
    lines = ["| robots | rounds to competence | of one robot | tasks of all |", "|---|---|---|---|"]
    for robots in (1, 2, 4, 8):
        name = f"{robots} robots: rounds to competence"
        low, high = (rows[f"{name}, {end} end of the 95 % interval"]["value"] for end in ("lower", "upper"))
        lines.append(
            f"| {robots} | {rows[name]['value']:.1f} [{low:.1f}, {high:.1f}] | {rows[name]['ratio']:.2f}"
            f" | {rows[f'{robots} robots: tasks of all until then']['value']:.1f} |"
        )
    return "\n".join(lines)


def goals_table(name: str = "fleet") -> str:
    lines = ["| goal | asked | measured | met |", "|---|---|---|---|"]
    for goal in result(name)["goals"]:
        asked = goal["goal"].replace("<=", "≤").replace(">=", "≥")
        met = "yes" if goal["met"] else "no"
        lines.append(f"| {goal['name']} | {asked} | {number(goal['measured'])} | {met} |")
    return "\n".join(lines)


def memory_table() -> str:
    lines = [
        "| contexts | file | opened in | read to open | recall one | store a task | load all | memory for it |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for contexts, found in result("large_memory")["contexts"].items():
        cells = (
            f"{int(contexts):,}",
            f"{number(found['file_bytes'] / 1e6)} MB",
            f"{number(1e3 * found['open'])} ms",
            f"{number(found['read_bytes'] / 1e6)} MB",
            f"{number(1e6 * found['recall'])} µs",
            f"{number(1e3 * found['contribute'])} ms",
            f"{number(found['load'])} s",
            f"{number(found['load_bytes'] / 1e6)} MB",
        )
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def pairs_line() -> str:
    rows = {row["name"]: row["value"] for row in result("large_memory")["rows"]}
    more = "a context more (2 actions counted): "
    some = rows["10,000,000 contexts: main memory of a process that reads and writes some"]
    pair = rows["file of a (context, action) or (context, type) more"]
    load = rows[more + "main memory to load all"]
    return (
        f"A (context, action) or (context, type) more adds {pair:.0f} bytes to the file, a context with two of "
        f"them {rows[more + 'file']:.0f}.\nLoading all needs at most {load:.0f} bytes of "
        f"main memory a context, of which 40 stay. A process that reads and\nwrites some contexts of ten million "
        f"grows by {number(some)} MB."
    )


PARTS = {
    "fleet": fleet_table,
    "fleet goals": goals_table,
    "customers": customers_table,
    "customers goals": lambda: goals_table("customer_fleet"),
    "large memory": memory_table,
    "pairs": pairs_line,
}


@pytest.mark.parametrize("part", PARTS)
def test_the_page_shows_its_results(part):
    assert f"<!-- {part} -->\n{PARTS[part]()}\n\n" in PAGE


def test_the_settings_are_those_of_the_benchmark():
    from benchmarks.fleet import customer_fleet, fleet
    from lifelore.memory import leases, sqlite_file

    assert f"`lifelore bench fleet --repeats {len(result('fleet')['rounds_to_competence']['1'])}`" in PAGE
    worlds = len(result("customer_fleet")["rounds_to_competence"]["1"])
    assert f"`lifelore bench customer_fleet --repeats {worlds}`" in PAGE
    assert (customer_fleet.COMPETENT, customer_fleet.WINDOW, customer_fleet.TESTS) == (0.5, 2, 8)
    assert f"one episode of {fleet.MOVES} moves" in PAGE
    assert (fleet.COMPETENT, fleet.WINDOW, leases.LEASE_SECONDS) == (0.1, 3, 3600)
    assert f"up to {sqlite_file.CHECKED_BYTES // 2**20} MiB" in PAGE
