"""docs/long_lived.md holds the numbers of results/bench_changing_customers.json."""

import json
from pathlib import Path

import pytest

from benchmarks.agent import changing_customers as case

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "long_lived.md").read_text(encoding="utf-8")
RESULT = json.loads((ROOT / "results" / "bench_changing_customers.json").read_text(encoding="utf-8"))
ROWS = {row["name"]: row for row in RESULT["rows"]}
SPANS = ("episode of the change", "1 episode after", "2 episodes after", "3 or more after", "all episodes")


def shown(name):
    """A number and its interval as the page has them."""
    row = ROWS[name]
    value, low, high = (round(number, 1) + 0.0 for number in (row["value"], *row["ci95"]))  # no "-0.0"
    return f"{value:.1f} [{low:.1f}, {high:.1f}]"


def line(world, agent, spans=SPANS):
    cells = [shown(f"{world}, {span}: {agent}") for span in spans]
    more = "–" if agent == "following" else shown(f"{world}, all episodes: {agent}, more than following")
    return f"| {agent} | " + " | ".join([*cells, more]) + " |"


@pytest.mark.parametrize("agent", case.AGENTS_OF["customers change"])
def test_the_table_of_changes(agent):
    assert line("customers change", agent) + "\n" in PAGE


@pytest.mark.parametrize("agent", case.AGENTS_OF["customers stay"])
def test_the_table_without_changes(agent):
    assert (
        line("customers stay", agent, ("first episodes", "later episodes before a change", "all episodes")) in PAGE
    )


def test_the_words_around_it():
    assert (
        f"`lifelore bench changing_customers --repeats {ROWS['customers change, all episodes: static']['n']}`"
        in PAGE
    )
    found, false = (
        ROWS[f"changes that {words}"]["value"]
        for words in (
            "were found in their episode, of those that came",
            "were believed and did not come, of all believed",
        )
    )
    assert f"It found {found:.0%} of the changes in their episode; {false:.0%} of those that it believed" in PAGE
    assert (case.CHANGE, case.N_TASKS, case.N_EPISODES, case.KNOWING) == (0.1, 20, 8, 5)
