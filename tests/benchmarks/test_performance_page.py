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


def measured(name: str) -> tuple[dict[str, float], dict[str, float]]:
    """Values and ratios of the rows of a stored result, by name."""
    rows = stored(name)["rows"]
    return {row["name"]: row["value"] for row in rows}, {row["name"]: row["ratio"] for row in rows}


def kernels() -> str:
    _, ratio = measured("kernels")
    names = ("C -O3 -march=native", "Gymnasium + NumPy", "tuned pure Python")
    c, textbook, tuned = (1 / ratio[name] for name in names)
    short = 1 / ratio["tuned pure Python, less work: first best action, no visits"]
    return f"{c:.1f} × C; {textbook:.0f} × Gymnasium; {tuned:.0f} × Python ({short:.0f} × if it does less work)"


def start() -> str:
    value, _ = measured("start")
    cloud = "perceive of a Kinect's PCD"
    warm = {verb.split(" of")[0]: value[f"lifelore {verb}, warm"] for verb in ("live", cloud, "reuse choose")}
    seconds = ", ".join(f"`{verb}` {took:.1f} s" for verb, took in warm.items())
    return f"warm: {seconds}; first ever: `live` {value['lifelore live, first ever']:.0f} s"


def perceive() -> str:
    value, _ = measured("perceive")
    few, many = (f"a Kinect's PCD ({scene}), " for scene in ("learn22", "test51"))
    shell = "from the shell: processor time"
    return (
        f"{value[few + 'in a program']:.0f} to {value[many + 'in a program']:.0f} ms; "
        f"{value[few + shell]:.1f} to {value[many + shell]:.1f} s"
    )


def separator() -> str:
    found = {goal["name"]: goal["measured"] for goal in stored("separator")["goals"]}
    fine, wide = "l = 60 mm, C₀ = 10", "l = 120 mm, C₀ = 1"
    few, more, many, most = (
        found[f"libsvm / ours, n = {n}, {setting}"] for n in (10_000, 100_000) for setting in (fine, wide)
    )
    return f"{few:.0f} to {more:.0f} × at 10,000 points; {many:.0f} to {most:.0f} × at 100,000"


def reuse() -> str:
    value, ratio = measured("reuse")
    default, sampling = (value[f"an episode, {rule}, exact models"] for rule in ("default rule", "sampling"))
    mabwiser, wabbit = (ratio[f"an episode, {name}"] for name in ("MABWiser UCB1", "Vowpal Wabbit cb_explore"))
    return (
        f"{default:.0f} µs, sampling {sampling:.0f} µs: {mabwiser:.1f} × MABWiser, {wabbit:.1f} × Vowpal Wabbit; "
        f"a million users: {value['users, sampling, exact models']:.1f} million/s, "
        f"{value['memory a user, exact models']:.0f} bytes each"
    )


def serve() -> str:
    _, ratio = measured("serve")
    return (
        f"{ratio['decision and outcome']:.2f} × a route that commits each row, "
        f"{ratio['decision and outcome, beside the other route']:.2f} × one that commits what waits"
    )


def test_the_table_of_the_service_says_what_was_measured():
    value, _ = measured("serve")
    numbers = (
        f"{value['decision and outcome']:,.0f}/s, "
        f"{value['processor time of a decision and its outcome']:.2f} ms of processor time, "
        f"p99 {value['99th percentile of a request, 32 connections']:.0f} ms",
        f"bare route {value['bare route that commits what waits']:,.0f}/s",
        f"| {value['batches of 1000 decisions']:,.0f} decisions/s |",
        f"| {value['100000 decisions in a request']:.1f} s; ",
        f"slowest single decision meanwhile {value['slowest single decision beside them']:.0f} ms",
    )
    for number in numbers:
        assert number in PAGE


def memory() -> str:
    value, ratio = measured("memory")
    file, opened, recalled = (
        value[f"10,000,000 contexts: {what}"] for what in ("file", "open", "recall one context")
    )
    return (
        f"{ratio['100 memories of 30 tasks, one by one']:.1f} × one by one; ten million contexts: "
        f"{file:.0f} MB, opened in {opened:.0f} ms, one read in {recalled:.0f} µs"
    )


def buildings() -> str:
    value, _ = measured("buildings")
    sizes = ("5,094", "79,849", "298,614")
    first, later = (
        ", ".join(f"{value[f'{which} task, {places} places']:.{digits}f}" for places in sizes)
        for which, digits in (("first", 1), ("later", 2))
    )
    return f"first {first} s; later {later} s"


def lives() -> str:
    value, _ = measured("lives")
    lore, scratch = (1e3 * value[name] for name in ("a task of lore, which remembers", "a task of scratch"))
    return f"`lore` {lore:.0f} ms, `scratch` {scratch:.0f} ms"


def priors() -> str:
    _, ratio = measured("priors")
    update, draw = (ratio[f"{what}, scattered codes: dict of lists"] for what in ("update", "sampling"))
    return (
        f"update {update:.0f} × dictionary, sampling {draw:.0f} ×; "
        f"tables {ratio['tables of four components, plain Python']:.0f} × Python"
    )


def personalise_value() -> str:
    value, _ = measured("personalise_value")
    parts = {"clicks": [], "minutes": []}
    for name in value:
        if name.endswith("default over LinUCB, country and history"):
            half = value[f"{name}, half the 95 % interval"]
            clicks = name.startswith("clicks")
            parts["clicks" if clicks else "minutes"].append(
                f"{value[name]:+.4f} ± {half:.4f}" if clicks else f"{value[name]:+.2f} ± {half:.2f}"
            )
    return "; ".join(f"{kind} {' and '.join(numbers)}" for kind, numbers in parts.items())


CELLS_MEASURED = [
    kernels, start, perceive, separator, reuse, serve, memory, buildings, lives, priors, personalise_value
]  # fmt: skip


@pytest.mark.parametrize("cell", CELLS_MEASURED)
def test_the_table_says_what_was_measured(cell):
    assert CELLS[cell.__name__] == cell()


def test_the_table_has_all_in_order():
    assert list(CELLS) == list(BENCHES)


def test_missed_goals_are_counted():
    goals = [goal for name in BENCHES for goal in stored(name)["goals"]]
    missed = [goal for goal in goals if goal["met"] is False]
    assert f"{len(missed)} of {len(goals)} goals are missed" in PAGE


def test_the_page_is_short():
    assert len(PAGE.split()) <= 700
