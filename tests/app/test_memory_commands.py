"""`lifelore memory …` from end to end, and what else says its piece in JSON: doctor, reproduce."""

import json
import re
import sqlite3
import tomllib
from pathlib import Path

import numpy as np
import pytest
import typer

from lifelore.app import reproduce_command
from lifelore.app.command_line import run
from lifelore.app.memory_table import print_memory
from lifelore.core.errors import InputError
from lifelore.memory import open_memory

ROOT = Path(__file__).parents[2]
OVERVIEW = {"location", "schema", "robots", "lore", "forgotten", "forgotten_records", "buildings"}
REPORT = {"lifelore", "python", "system", "cores", "packages", "checks"}


def recalls(path: Path) -> dict:
    """All that a memory knows, as plain data; it must be sound."""
    with open_memory(path) as memory:
        assert memory.check() == []
        return {
            (kind, key, version): _plain(memory.recall(kind, key, version))
            for kind in ("action_prior", "transitions")
            for key, version, _ in memory.keys(kind)
        }


def _plain(record) -> tuple:
    return record.merge, np.asarray(record.slots).tolist(), np.asarray(record.values).tolist(), record.about


def robots(path: Path) -> dict[str, int]:
    with open_memory(path) as memory:
        return {robot: memory.tasks(robot) for robot in memory.robots()}


@pytest.fixture(scope="module")
def homes(tmp_path_factory) -> Path:
    """A folder with the memories of two robots, of two and three tasks; read only."""
    folder = tmp_path_factory.mktemp("homes")
    for seed, robot in enumerate(("rosie", "wally")):
        options = ["--tasks", str(2 + seed), "--robot", robot, "--seed", str(seed)]
        assert run(["live", "--domain", "lattice", *options, "--memory", str(folder / f"{robot}.db")]) == 0
    return folder


def test_several_memories_come_in_at_once(ask, homes, tmp_path):
    names = [homes / f"{robot}.db" for robot in ("rosie", "wally")]
    both = ask("memory", "merge", *names, "--memory", "both.db", "--json").document
    assert both == {
        "added": 5, "already_there": 0, "forgotten": 0,
        "sources": [
            {"source": str(names[0]), "added": 2, "already_there": 0, "forgotten": 0},
            {"source": str(names[1]), "added": 3, "already_there": 0, "forgotten": 0},
        ],
    }  # fmt: skip
    said = ask("memory", "import", *names, names[0], "--memory", "other.db").out
    assert said == "contributions: 5 added, 2 already there, 0 forgotten, from 3 memories\n"
    assert recalls(tmp_path / "other.db") == recalls(tmp_path / "both.db")
    file = tmp_path / "rosie.lore"
    exported = ask("memory", "export", file, "--memory", names[0], "--json").document
    assert exported == {"exported": 2, "file": str(file)}
    again = ask("memory", "import", file, "--memory", "both.db", "--json").document
    assert again == {"added": 0, "already_there": 2, "forgotten": 0}
    # Who forgets forgets for good, and the tombstone travels.
    said = ask("memory", "forget", "wally", "--memory", "both.db", "--json").document
    assert said == {"forgotten": 3, "robot": "wally"}
    assert recalls(tmp_path / "both.db") == recalls(names[0])
    assert ask("memory", "merge", names[1], "--memory", "both.db", "--json").document["forgotten"] == 3
    assert ask("memory", "merge", "both.db", "--memory", "other.db", "--json").document["forgotten"] == 3
    assert robots(tmp_path / "other.db") == {"rosie": 2}


def test_one_missing_memory_among_several_refuses_all(ask, homes, tmp_path):
    refusal = ask("memory", "merge", homes / "rosie.db", "nobody.db", "--memory", "both.db").refusal
    assert "nobody.db does not exist" in refusal
    assert robots(tmp_path / "both.db") == {}


def test_show(ask, known):
    shown = ask("memory", "show", "--memory", known, "--json").document
    assert set(shown) == OVERVIEW
    assert (shown["location"], shown["forgotten"]) == (str(known), 0)
    (robot,) = shown["robots"]
    assert set(robot) == {"robot", "tasks", "first", "last"}
    assert (robot["robot"], robot["tasks"]) == ("robot", 2)
    assert [lore["kind"] for lore in shown["lore"]] == ["action_prior", "transitions"]
    for lore in shown["lore"]:
        assert set(lore) == {"kind", "key", "version", "merge", "slots", "sum"}
        assert lore["slots"] > 0


def test_what_a_person_reads(ask, known):
    said = ask("memory", "show", "--memory", known)
    assert (said.status, said.err) == (0, "")
    for words in ("robots", "robot", "records", "action_prior", "transitions"):
        assert words in said.out
    assert ask("memory", "export", "all.lore", "--memory", known).out == "2 contributions written to all.lore\n"
    imported = "contributions: 0 added, 2 already there, 0 forgotten\n"
    assert ask("memory", "import", "all.lore", "--memory", known).out == imported
    assert ask("memory", "forget", "robot", "--memory", known).out == "2 contributions of robot forgotten\n"
    assert "2 contributions were forgotten" in ask("memory", "show", "--memory", known).out


def test_ten_thousand_records_of_a_sort_are_one_line(capsys):
    lore = [{"kind": "policies", "key": f"s/{n:04}", "version": 1, "merge": "newest", "slots": 3, "sum": n}
            for n in range(10_000)]  # fmt: skip
    place = {"location": "m.db", "schema": 2, "forgotten": 0, "forgotten_records": 0, "buildings": []}
    print_memory(place | {"robots": [], "lore": [lore[0] | {"key": "s"}, *lore]})
    said = capsys.readouterr().out
    assert len(said.splitlines()) < 20
    assert "s/… (10,000)" in said
    assert "30,000" in said
    print_memory(place | {"robots": [], "lore": lore[:8]})
    few = capsys.readouterr().out
    assert "…" not in few
    assert "s/0007" in few
    print_memory(place | {"robots": [], "lore": [lore[0] | {"key": f"{'0af1' * 8}/dock of the bakery"}]})
    assert "│ 0af10af10af1/dock of the bakery │" in capsys.readouterr().out


def test_doctor(ask, known):
    report = ask("doctor", "--memory", known, "--json").document
    assert set(report) == REPORT
    assert all(set(entry) == {"name", "version", "for", "extra"} for entry in report["packages"])
    extras = {entry["extra"] for entry in report["packages"]} - {None}
    assert extras <= set(tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"])
    assert all(set(entry) == {"what", "ok", "finding", "advice"} for entry in report["checks"])
    checks = {entry["what"]: entry for entry in report["checks"]}
    assert set(checks) == {"kernels", "kernel cache", "memory"}
    assert checks["memory"] == {
        "what": "memory", "ok": True, "finding": f"{known}, 1 robots", "advice": None,
    }  # fmt: skip
    said = ask("doctor", "--memory", known)
    assert (said.status, said.err) == (0, "")
    assert all(name in said.out for name in ("numba", "clingo", "ok   memory"))


def test_doctor_finds_what_is_wrong_and_leaves_it(ask, tmp_path):
    (tmp_path / "diary.txt").write_text("Dear diary")
    said = ask("doctor", "--memory", "diary.txt")
    assert said.status == 1
    assert "BAD  memory" in said.out
    assert "is not a Lifelore memory" in " ".join(said.out.split())
    assert "To repair it: name another file" in " ".join(said.out.split())
    assert (tmp_path / "diary.txt").read_text() == "Dear diary"


def test_doctor_checks_every_record(ask, known):
    with sqlite3.connect(known) as conn:
        conn.execute("UPDATE lifelore_cells SET value = value + 1")
    said = ask("doctor", "--memory", known, "--json")
    (memory,) = (entry for entry in said.document["checks"] if entry["what"] == "memory")
    assert (said.status, memory["ok"]) == (1, False)
    assert "lifelore memory import EXPORT --memory NEW" in memory["advice"]


def test_reading_verbs_create_no_memory(ask, tmp_path):
    for verb in (["show"], ["export", "export.db"], ["forget", "robot"]):
        refused = ask("memory", *verb, "--memory", "typo/m.db")
        assert refused.status == 2
        assert "typo/m.db does not exist; check the path" in refused.err
    assert "the first life creates" in ask("memory", "show").err
    said = ask("doctor", "--memory", "typo/m.db")
    assert said.status == 1
    assert "check the path" in said.out
    assert not list(tmp_path.glob("**/*.db"))


def test_the_list_of_claims(ask):
    entries = ask("reproduce", "--list", "--json").document
    assert all(set(entry) == {"claim", "figure", "title", "sentence"} for entry in entries)
    said = ask("reproduce", "--list")
    assert (said.status, said.err) == (0, "")
    assert all(entry["claim"] in said.out for entry in entries)


@pytest.mark.parametrize(("name", "as_json"), [("C3.1", True), ("3.1", False)])
def test_a_claim_from_the_command_line(name, as_json, ask, tmp_path):
    options = ("--set", "mazes=2", "--set", "tasks=3", "--out", "results", "--jobs", 1)
    said = ask("reproduce", name, *options, *(["--json"] if as_json else []))
    assert (said.status, said.err) == (0, "")
    assert (tmp_path / "results/C3.1/result.json").is_file()
    if as_json:
        (result,) = said.document
        assert (result["claim"], result["mode"]) == ("C3.1", "quick")
    else:
        result = json.loads((tmp_path / "results/C3.1/result.json").read_text(encoding="utf-8"))
        words = " ".join(said.out.split())
        assert f": {result['verdict']}; a small run, no evidence" in words
        shown = re.findall(r"^  ([✓½✗–]{3}) ", said.out, flags=re.M)
        assert shown == ["".join(marks) for marks in result["marks"].values()]
        assert "results/C3.1/figure.png\n" in said.out


@pytest.mark.parametrize("arguments", [[], ["3.7", "--full"], ["--list"]], ids=" ".join)
def test_reproduce_elsewhere_names_the_checkout(arguments, monkeypatch, tmp_path):
    monkeypatch.setattr(reproduce_command, "CHECKOUT", tmp_path)
    app = typer.Typer()
    reproduce_command.add_reproduce(app)
    with pytest.raises(InputError, match="runs in a checkout of the repository"):
        app(arguments, standalone_mode=False)


@pytest.mark.slow
def test_a_building_is_written_for_nav2_from_memory(ask, tmp_path):
    map = Path(__file__).parents[2] / "examples" / "data" / "office.yaml"
    where = ("--memory", tmp_path / "m.db")
    alone = ("--agent", "lore", "--set", "compare=false")
    assert ask("live", "--map", map, "--tasks", 2, *alone, "--out", tmp_path / "life", *where).status == 0
    found = ask("memory", "nav2", map, "--out", tmp_path / "nav2", *where, "--json").document
    assert found["out"] == str(tmp_path / "nav2")
    assert {path.name for path in (tmp_path / "nav2").iterdir()} == set(found["files"])
    for name in found["files"]:
        assert (tmp_path / "nav2" / name).read_bytes() == (tmp_path / "life" / name).read_bytes()
    # Memory knows no place of this building by name, so there is no graph.
    assert ask("memory", "nav2", map, "--out", tmp_path / "nav2", *where).out.startswith("6 files written to")
