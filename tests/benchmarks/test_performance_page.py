"""docs/performance.md: its table says what the stored results of the benchmarks hold."""

import json
import re
from pathlib import Path

import pytest

from benchmarks import BENCHES

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "performance.md").read_text(encoding="utf-8")
LINE = r"^\| \[(\w+)\]\(\.\./benchmarks/results/\1\.json\) \|.*\| ([^|]+) \|$"
CELLS = dict(re.findall(LINE, PAGE, flags=re.M))
"""Each benchmark's cell of what was measured."""


def stored(name: str) -> dict:
    """The stored result of a benchmark."""
    return json.loads((ROOT / "benchmarks" / "results" / f"{name}.json").read_text(encoding="utf-8"))


def measured(name: str) -> dict[str, dict[str, float]]:
    """The numbers of a stored result by name: values, a thousand times these, ratios, 1 / ratio, and goals."""
    rows, goals = stored(name)["rows"], stored(name)["goals"]
    ratio = {row["name"]: row["ratio"] for row in rows if row["ratio"]}
    return {
        "v": {row["name"]: row["value"] for row in rows},
        "k": {row["name"]: 1e3 * row["value"] for row in rows if row["value"] is not None},
        "r": ratio,
        "i": {row: 1 / number for row, number in ratio.items()},
        "g": {goal["name"]: goal["measured"] for goal in goals},
    }


PCD, PYTHON = "perceive of a Kinect's PCD", "tuned pure Python, less work: first best action, no visits"
GAIN = "default over LinUCB, country and history"
TEXTS = {
    "kernels": "{i[C -O3 -march=native]:.1f} × C; {i[Gymnasium + NumPy]:.0f} × Gymnasium; "
    f"{{i[tuned pure Python]:.0f}} × Python ({{i[{PYTHON}]:.0f}} × if it does less work)",
    "start": f"warm: `live` {{v[lifelore live, warm]:.1f}} s, `perceive` {{v[lifelore {PCD}, warm]:.1f}} s, "
    "`reuse choose` {v[lifelore reuse choose, warm]:.1f} s; first ever: "
    "`live` {v[lifelore live, first ever]:.0f} s",
    "perceive": "{v[a Kinect's PCD (learn22), in a program]:.0f} to "
    "{v[a Kinect's PCD (test51), in a program]:.0f} ms; "
    "{v[a Kinect's PCD (learn22), from the shell: processor time]:.1f} to "
    "{v[a Kinect's PCD (test51), from the shell: processor time]:.1f} s",
    "separator": "{g[libsvm / ours, n = 10000, l = 60 mm, C₀ = 10]:.0f} to "
    "{g[libsvm / ours, n = 10000, l = 120 mm, C₀ = 1]:.0f} × at 10,000 points; "
    "{g[libsvm / ours, n = 100000, l = 60 mm, C₀ = 10]:.0f} to "
    "{g[libsvm / ours, n = 100000, l = 120 mm, C₀ = 1]:.0f} × at 100,000",
    "reuse": "{v[an episode, default rule, exact models]:.0f} µs, sampling "
    "{v[an episode, sampling, exact models]:.0f} µs: {r[an episode, MABWiser UCB1]:.1f} × MABWiser, "
    "{r[an episode, Vowpal Wabbit cb_explore]:.1f} × Vowpal Wabbit; a million users: "
    "{v[users, sampling, exact models]:.1f} million/s, {v[memory a user, exact models]:.0f} bytes each",
    "serve": "{r[decision and outcome]:.2f} × a route that commits each row, "
    "{r[decision and outcome, beside the other route]:.2f} × one that commits what waits",
    "memory": "{r[100 memories of 30 tasks, one by one]:.1f} × one by one; ten million contexts: "
    "{v[10,000,000 contexts: file]:.0f} MB, opened in {v[10,000,000 contexts: open]:.0f} ms, one read in "
    "{v[10,000,000 contexts: recall one context]:.0f} µs",
    "buildings": "first {v[first task, 5,094 places]:.1f}, {v[first task, 79,849 places]:.1f}, "
    "{v[first task, 298,614 places]:.1f} s; later {v[later task, 5,094 places]:.2f}, "
    "{v[later task, 79,849 places]:.2f}, {v[later task, 298,614 places]:.2f} s",
    "lives": "`lore` {k[a task of lore, which remembers]:.0f} ms, `scratch` {k[a task of scratch]:.0f} ms",
    "priors": "update {r[update, scattered codes: dict of lists]:.0f} × dictionary, sampling "
    "{r[sampling, scattered codes: dict of lists]:.0f} ×; tables "
    "{r[tables of four components, plain Python]:.0f} × Python",
}
"""Each benchmark's cell of what was measured, with the names of its numbers."""
SERVICE = (
    "{v[decision and outcome]:,.0f}/s, {v[processor time of a decision and its outcome]:.2f} ms of processor "
    "time, p99 {v[99th percentile of a request, 32 connections]:.0f} ms",
    "bare route {v[bare route that commits what waits]:,.0f}/s",
    "| {v[batches of 1000 decisions]:,.0f} decisions/s |",
    "| {v[100000 decisions in a request]:.1f} s; ",
    "slowest single decision meanwhile {v[slowest single decision beside them]:.0f} ms",
)


@pytest.mark.parametrize("name", TEXTS)
def test_the_table_says_what_was_measured(name):
    assert CELLS[name] == TEXTS[name].format(**measured(name))


def test_the_table_says_how_much_more_personal_choices_earn():
    value, parts = measured("personalise_value")["v"], {"clicks": [], "minutes": []}
    for name in [name for name in value if name.endswith(GAIN)]:
        kind, digits = ("clicks", 4) if name.startswith("clicks") else ("minutes", 2)
        half = value[f"{name}, half the 95 % interval"]
        parts[kind].append(f"{value[name]:+.{digits}f} ± {half:.{digits}f}")
    cell = "; ".join(f"{kind} {' and '.join(numbers)}" for kind, numbers in parts.items())
    assert CELLS["personalise_value"] == cell


@pytest.mark.parametrize("text", SERVICE)
def test_the_table_of_the_service_says_what_was_measured(text):
    assert text.format(**measured("serve")) in PAGE


def test_the_table_has_all_in_order():
    assert list(CELLS) == list(BENCHES)
    assert {*TEXTS, "personalise_value"} == set(BENCHES)


def test_missed_goals_are_counted():
    goals = [goal for name in BENCHES for goal in stored(name)["goals"]]
    missed = [goal for goal in goals if goal["met"] is False]
    assert f"{len(missed)} of {len(goals)} goals are missed" in PAGE


def test_the_page_is_short():
    assert len(PAGE.split()) <= 700
