"""docs/performance.md says what the results of its benchmarks hold."""

import json
import re
from pathlib import Path

import pytest

from reproduction.engine.run_again import minutes, simulates_physics

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "performance.md").read_text()
MARKS = re.findall(r"^<!-- goals (\w+) -->$", PAGE, flags=re.M)


def number(value: float) -> str:
    return f"{value:,.0f}" if value >= 100 else f"{value:.2g}" if value < 10 else f"{value:.0f}"


def goals_table(name: str) -> str:
    """The goals of a stored result as the page's table."""
    goals = json.loads((ROOT / "results" / f"bench_{name}.json").read_text())["goals"]
    rows = [
        f"| {goal['name']} | {goal['goal'].replace('<=', '≤').replace('>=', '≥')} | {number(goal['measured'])} |"
        f" {'yes' if goal['met'] else 'no'} |"
        for goal in goals
    ]
    return "\n".join(["| goal | asked | measured | met |", "|---|---|---|---|", *rows])


@pytest.mark.parametrize("name", MARKS)
def test_goals_are_those_of_the_result(name):
    assert f"<!-- goals {name} -->\n{goals_table(name)}\n\n" in PAGE


def test_every_part_has_its_goals_and_its_command():
    assert MARKS == ["kernels", "start", "buildings", "merge", "serve", "soak"]
    for name in [*MARKS, "capacity"]:
        assert f"`lifelore bench {name} --repeats" in PAGE
        assert (ROOT / "results" / f"bench_{name}.json").exists()


def test_the_cost_of_a_million_learners_is_the_results():
    result = json.loads((ROOT / "results" / "bench_capacity.json").read_text())
    rows = {row["name"]: row["value"] for row in result["rows"]}
    million = "Q-learners, 1,000,000: "
    for said in (
        f"a million hold {rows[million + 'memory (extrapolated)']:.0f} GB",
        f"1,000 steps of each take {rows[million + '1,000 steps of each, one core (extrapolated)']:.0f} s",
        f"Ten million hold {rows['contexts, 10,000,000: memory'] / 1000:.2f} GB",
        f"counts {rows['contexts, 10,000,000: counted once more']:.1f} million",
        f"fall from {rows['Q-learners, 1: one core']:.0f} to {rows['Q-learners, 10,000: one core']:.0f} million",
    ):
        assert said in PAGE


def test_running_all_claims_again_took_what_the_page_says():
    found = json.loads((ROOT / "results" / "verify.json").read_text())
    own = [one for one in found if not simulates_physics(one["claim"]) and one["claim"] != "C4.14"]
    assert f"with the {len(own)} claims that neither" in PAGE
    assert f"{minutes(own):.0f} minutes of processor time" in PAGE
    assert f"The other {len(found) - len(own)} claims" in PAGE
