"""docs/perception.md says what the benchmarks under results/ hold."""

import json
import re
from pathlib import Path

import pytest

from benchmarks.perception.perceive import REAL_SCENES
from benchmarks.perception.process_parts import PARTS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "perception.md").read_text(encoding="utf-8")
SEGMENTATION = re.findall(r"^\| (real|simulated): method .*\n\|[-|]*\n((?:\|.*\n)+)", PAGE, flags=re.M)
METHODS = re.findall(
    r"^\| (?!method)([a-z][^|]+?) \| (0\.\d{3} \[.+)\|$", PAGE.split("## Accuracy beside")[1], flags=re.M
)
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


@pytest.mark.parametrize(("title", "how"), [("labels given", ""), ("without labels", " without labels")])
def test_plans(title, how):
    found = rows("plans")
    lines = re.search(rf"^\| {title}: least probability .*\n\|[-|]*\n((?:\|.*\n)+)", PAGE, flags=re.M)
    assert lines
    table = re.findall(r"^\| (0[.\d]*)(?: \(default\))? \| (0\.\d{3} \|.+) \|$", lines.group(1), flags=re.M)
    assert len(table) == 5
    for least, cells in table:
        names = [
            f"{where}{how}, hidden tops unknown, from {float(least):g}: {measure}"
            for where in ("simulated", "real")
            for measure in ("objects with a plan", "valid plans")
        ]
        for name, cell in zip(names, cells.split("|"), strict=True):
            value, *ends = map(float, re.findall(r"\d\.\d+", cell))
            assert value == pytest.approx(found[name]["value"], abs=6e-4)
            assert not ends or ends == pytest.approx(found[name]["ci95"], abs=6e-3)


@pytest.mark.parametrize(("how", "words"), [("", "with labels given"), (" without labels", "without labels")])
def test_valid_plans_at_the_default(how, words):
    told = re.search(
        rf"(0\.\d+) \[(0\.\d+), (0\.\d+)\](?: of the real objects)? {words} \(goal (0\.\d+): (\S+)\)", PAGE
    )
    assert told
    row = rows("plans")[f"real{how}, hidden tops unknown, from 0.6: objects with a valid plan"]
    assert float(told[1]) == pytest.approx(row["value"], abs=6e-4)
    assert [float(told[2]), float(told[3])] == pytest.approx(row["ci95"], abs=6e-3)
    assert told[5] == ("met" if row["value"] >= float(told[4]) else "**missed**")


def test_puzzles():
    found = rows("puzzles")
    told = re.findall(
        r"^\| (labels given|without labels) \| (\d\.\d{3} \[.+) \| (.+) \| (\d+) \| (\d+) \|$", PAGE, flags=re.M
    )
    assert [way for way, *_ in told] == ["labels given", "without labels"]
    for way, *cells, missed, failed in told:
        for name, cell in zip(("solved", "solved at the first look"), cells, strict=True):
            value, *ends = map(float, re.findall(r"\d\.\d+", cell))
            assert value == pytest.approx(found[f"{way}: {name}"]["value"], abs=6e-4)
            assert ends == pytest.approx(found[f"{way}: {name}"]["ci95"], abs=6e-3)
        reasons = {
            name.partition("not solved, ")[2]: row["value"] for name, row in found.items() if f"{way}: not" in name
        }
        assert int(missed) == reasons.pop("a block is not found")
        assert int(failed) == sum(reasons.values())
    planned = sum(found[f"{way}: puzzles with a plan"]["value"] for way in ("labels given", "without labels"))
    assert f"All {planned} plans that were made reached their goal" in PAGE
    assert f"in {found['labels given: steps of a solved puzzle']['value']:.1f} steps on the average" in PAGE
    assert [goal["met"] for goal in bench("puzzles")["goals"]] == [True, False]


def check_views(found, how, cells):
    """The cells of a line: what is told of scenes seen so."""
    for measure, cell in zip(("exact", "on", "contacts found"), cells.split("|"), strict=True):
        row = found[f"{measure}, {how}"]
        value, *ends = map(float, re.findall(r"\d\.\d+", cell))
        assert value == pytest.approx(row["value"], abs=6e-4)
        assert ends == pytest.approx(row["ci95"], abs=6e-3)


def test_views():
    found = rows("views")
    lines = re.findall(r"^  \| ([123]) \| (0\.\d{3} .+) \|$", PAGE, flags=re.M)
    assert len(lines) == 3
    for number, cells in lines:
        check_views(found, f"{number} view{'s' if number != '1' else ''}", cells)
    for number, words in ((2, "two views less one view are"), (3, "three views less one")):
        told = re.search(rf"{words} \+(0\.\d+) \[(0\.\d+), (0\.\d+)\]", PAGE)
        row = found[f"exact, {number} views less 1 view, the same pairs"]
        assert told
        assert [float(told[n]) for n in (1, 2, 3)] == pytest.approx([row["value"], *row["ci95"]], abs=6e-4)


def test_registration():
    found = rows("registration")
    angles = re.findall(
        r"^  \| (20°|45°|90°|all) \| (\d+) \| (.+?) \| (.+?) \| (.+?), (.+?) \| (.+?), (.+?) \|$", PAGE, flags=re.M
    )
    assert len(angles) == 4
    for angle, pairs, refused, wrong, *errors in angles:
        where = "all angles" if angle == "all" else f"cameras {angle} apart"
        for word, cell in (("refused", refused), ("wrong", wrong)):
            row = found[f"registration {word}, {where}"]
            value, *ends = map(float, re.findall(r"\d\.\d+", cell))
            assert (int(pairs), value) == (row["n"], pytest.approx(row["value"], abs=6e-4))
            assert ends == pytest.approx(row["ci95"], abs=6e-3)
        levels = [(word, level) for word in ("turn", "shift") for level in ("median", "95th percentile")]
        for (word, level), cell in zip(levels, errors, strict=True):
            row = found[f"registration error of {word}, {level}, {where}"]
            assert float(cell) == pytest.approx(row["value"], abs=0.06)
    gains = re.findall(
        r"^  \| (1 view|2 views, true poses|2 views, registered) \| (0\.\d{3} .+) \|$", PAGE, flags=re.M
    )
    assert len(gains) == 3
    for how, cells in gains:
        check_views(found, how, cells)


def test_arrangements():
    found = rows("relations")
    lines = re.search(r"^\| arrangement \| pairs .*\n\|[-|]*\n((?:\|.*\n)+)", PAGE, flags=re.M)
    assert lines
    table = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[1].splitlines()]
    assert len(table) == 6
    measures = ("exact", "on", "recall of both", "exact, pairs with the table", "calibration error")
    for name, pairs, *cells in table:
        where = name.removeprefix("all of the table above, ") if "above" in name else f"simulated {name}"
        for measure, cell in zip(measures, cells, strict=True):
            row = found[f"ours as shipped with scene logic, {where}, {measure}"]
            value, *ends = map(float, re.findall(r"\d\.\d+", cell))
            assert value == pytest.approx(row["value"], abs=6e-3 if measure.startswith("recall") else 6e-4)
            assert not ends or ends == pytest.approx(row["ci95"], abs=6e-3)
        assert int(pairs) == found[f"ours as shipped with scene logic, {where}, exact"]["n"]


def test_raw_frames():
    found = rows("raw_frames")
    titles = {
        "plain": "plain", "against a wall": "table against a wall", "shelf": "shelf above the table",
        "furniture": "cabinet, chair, second table", "glass table": "glass table",
    }  # fmt: skip
    for kind, title in titles.items():
        n = 12
        shares = (
            found[f"{kind}, {n} frames, largest plane: right"],
            found[f"{kind}, {n} frames, evidence: right"],
            found[f"{kind}, evidence: false table"],
        )
        objects = ", ".join(f"{found[f'{kind}: objects {part}']['value']}" for part in ("true", "cut", "found"))
        counts = " | ".join(f"{n * share['value']:.0f}" for share in shares)
        assert f"| {title} | {n} | {counts} | {objects} |\n" in PAGE
    right, false = found["all rooms, 60 frames, evidence: right"], found["all rooms, evidence: false table"]
    assert f"({60 * right['value']:.0f} of 60)" in PAGE
    assert f"({60 * false['value']:.0f} of 60)" in PAGE


def test_everybody_is_in_the_table():
    told = {name.split(",")[0] for name in rows("relations") if name.endswith(", real, exact")}
    # Ours are shown with the logic that goes with them alone.
    assert {method for method, _ in METHODS} == told - {"ours", "ours as shipped"}


def test_what_the_goals_measured_is_told():
    told = {
        "perceive": (
            "0.53 s (goal 0.4: **missed**)",
            "0.80 s (goal 0.4: **missed**)",
            "0.24, 0.37 and 0.51 s (goal 0.4",
            "0.85, 1.07 and 1.12 s (goal 0.8",
            "0.31 s (goal 0.3",
        ),
        "separator": ("6.4, 18.8, 52 times", "17.8, 54, 129 times", "4.0 and 3.6 ms", "3.0 and 0.24 s"),
    }
    for name, words in told.items():
        assert all(text in PAGE for text in words)
        measured = [goal["measured"] for goal in bench(name)["goals"]]
        for text in words:
            for number in re.findall(r"\d+(?:\.\d+)?", text.split("(")[0]):
                decimals = len(number.partition(".")[2])
                assert any(f"{value:.{decimals}f}" == number for value in measured), number


def test_segmentation():
    found = rows("segmentation")
    measures = ("weighted overlap", "over-segmentation", "under-segmentation", "found")
    relations = ("relation precision", "relation recall", "relation F1")
    assert [where for where, _ in SEGMENTATION] == ["real", "simulated"]
    for where, table in SEGMENTATION:
        lines = [[cell.strip() for cell in line.strip("|\n").split("|")] for line in table.splitlines()]
        told = {name.split(",")[0] for name in found if f", {where}, weighted" in name}
        assert {line[0] for line in lines} == told
        for method, *cells, milliseconds in lines:
            for cell, measure in zip(cells, measures + relations, strict=True):
                row = found[f"{method}, {where}, {measure}"]
                if row["value"] is None:
                    assert cell == "–"
                    continue
                value, *ends = map(float, re.findall(r"\d\.\d+", cell))
                assert value == pytest.approx(row["value"], abs=6e-4)
                assert not ends or ends == pytest.approx(row["ci95"], abs=6e-3)
            seconds = found[f"{method}, {where}, processor time, objects"]["value"]
            assert float(milliseconds) == pytest.approx(seconds, abs=0.51)


def test_confidences_of_cuts_are_those_of_the_benchmark():
    found = rows("segmentation")
    told = re.search(r"by bands of confidence: real scenes (.*?); simulated scenes (.*?)\.\n", PAGE, flags=re.S)
    assert told
    for where, text in zip(("real", "simulated"), told.groups(), strict=True):
        bands = [name for name in found if f", {where}, cut confidence" in name and name.endswith("mean")]
        stated = re.findall(r"([\d.]+) stated,\s+([\d.]+)\s+right\s+\((\d+)\)", text)
        assert len(stated) == len(bands)
        for (mean, right, n), name in zip(stated, bands, strict=True):
            assert float(mean) == pytest.approx(found[name]["value"], abs=6e-3)
            assert float(right) == pytest.approx(found[name.replace("mean", "right")]["value"], abs=6e-3)
            assert int(n) == found[name]["n"]


def test_the_parts_of_a_process_are_those_of_the_benchmark():
    found = rows("perceive")
    for part in (*PARTS, "all parts"):
        scenes = (f"a Kinect's PCD ({scene}), from the shell: {part}" for scene in REAL_SCENES)
        assert f"| {part} | " + " | ".join(f"{found[name]['value']:.0f}" for name in scenes) + " |\n" in PAGE


def test_lived_relations():
    found = rows("lived_relations")

    def told(name: str, sign: str = "") -> str:
        row = found[name]
        ends = row["ci95"]
        return f"{row['value']:{sign}.3f}" + (f" [{ends[0]:{sign}.3f}, {ends[1]:{sign}.3f}]" if ends else "")

    for measure, names in {
        "who carries whom, labels from picks beside perception before": (
            "right about carrying, labels",
            "right about carrying, perception before",
            "right about carrying, labels less perception",
        ),
        "exact relation in new scenes, model of a life beside the shipped one": (
            "exact relation, model of the life",
            "exact relation, shipped model",
            "exact relation, model of the life less shipped",
        ),
    }.items():
        learnt, other, difference = names
        assert f"  | {measure} | {told(learnt)} | {told(other)} | {told(difference, '+')} |\n" in PAGE
    labels, trays = "labelled pairs that a model learns from", "trays that a model learns from"
    assert f"{found[labels]['value']:.1f} pairs a task" in PAGE
    assert f"from {found[trays]['value']:.0f} trays" in PAGE
    corrected = found["labels that correct perception"]["value"]
    spoilt = found["labels that are wrong where perception was right"]["value"]
    assert f"corrects perception {corrected:.1f} times a life\n  and spoils it {spoilt:.1f} times" in PAGE
    assert f"of {120 * found[labels]['n'] * found[labels]['value']:.0f} labels are wrong" in PAGE
    assert f"({found[labels]['n']} lives of 120 tasks)" in PAGE
    assert [goal["met"] for goal in bench("lived_relations")["goals"]] == [True, False]
