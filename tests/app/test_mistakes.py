"""Whatever a person may get wrong: exit 2, one line that names what was wrong, and nothing lost.

Each case is a command and what its line must say. `{new}` is a memory not yet there, `{known}` one of two tasks,
`{text}` a text file, `{folder}` an empty folder, `{map}` a sound map of a small room, `{cloud}` a labelled cloud.
"""

import os
import random
import shlex
import shutil
import sqlite3
import string
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from lifelore.domains.buildings.occupancy_map import OccupancyMap, write_occupancy_map
from lifelore.memory import open_memory

LATTICE = "live --memory {known} --domain lattice --tasks 1"
BUILDING = "live --memory {known} --tasks 1 --map {map}"
NOISE = "live --memory {known} --tasks 1 --domain noise"
LONG = "x" * 300

ASKED_WRONGLY = {
    "nonsense": "No such command 'nonsense'",
    "--nonsense": "No such option: --nonsense",
    "live --tasks": "--tasks",
    "live extra": "extra",
    "memory nonsense": "No such command 'nonsense'",
    "memory export": "Missing argument",
    "memory forget --memory {known}": "forget needs a robot, --source RUNS (of one robot or of all) or --building",
}
# A case for each setting, so that its rule is known to be asked; the rules have their own tests.
NUMBERS = {
    f"{LATTICE} --tasks x": "'--tasks'",
    f"{LATTICE} --tasks 0": "tasks must be a whole number from 1 to 1,000,000, got 0",
    f"{LATTICE} --tasks {10**24}": "tasks must be",
    f"{LATTICE} --seed x": "'--seed'",
    f"{LATTICE} --set jobs=0": "jobs must be",
    f"{LATTICE} --set episodes={10**10}": "episodes must be",
    f"{LATTICE} --set max_steps=0": "max_steps must be",
    f"{LATTICE} --set destinations=342": "at most the 341 free places",
    f"{LATTICE} --set discount=x": "discount must be a number, got 'x'",
    f"{LATTICE} --set discount=nan": "discount must",
    f"{LATTICE} --set discount=0 --set start=1,1": "discount",
    f"{LATTICE} --set goal_reward=inf": "goal_reward must be",
    f"{LATTICE} --set wall_reward=nan": "wall_reward must be",
    f"{LATTICE} --set alpha0=0": "alpha0 must be",
    f"{LATTICE} --set weight=-1": "weight must",
    f"{LATTICE} --set density=0.5": "density",
    f"{NOISE} --set density=1.5": "density must",
    f"{LATTICE} --set cell=nan --json": "cell does not apply",
    f"{BUILDING} --set cell=1e-300": "cell must",
    f"{BUILDING} --set robot_radius=-0.1": "robot_radius must",
}
NAMES = {
    f"{LATTICE} --domain moon": "building-days, got 'moon'",
    f"{LATTICE} --agent bob": "agent must be one of lore",
    f"{LATTICE} --robot 'two\nlines'": "robot must",
    f"{LATTICE} --set start=0,0": "start must be a free cell ROW,COL of this world (23 rows, 23 columns), got 0,0",
    f"{LATTICE} --set start={10**20},1": "start must be a free cell",
    f"{LATTICE} --goal 0,0": "the nearest free cell is 1,1",
    f"{LATTICE} --goal dock": "goal must be ROW,COL",
    f"{LATTICE} --set start=3": "start must be ROW,COL",
    "memory forget nobody --memory {known}": "robot 'nobody' has contributed nothing here; known robots: robot",
    "memory forget --source none.csv --memory {known}": "has taught nothing here; known sources: none",
    "reproduce C9.9": "no claim or figure 'C9.9'",
    "reproduce C3.1 --verify --full": "takes mode, settings and seed from the stored result",
    "reproduce C3.1 --verify --out {folder}": "no result of C3.1 in",
    "reproduce C3.1 --set x": "KEY=VALUE",
    "reproduce C3.1 --set x=1 --out {folder}": "has no setting 'x'",
    "reproduce C3.1 --set tasks=nan --out {folder}": "setting 'tasks' must be of the type of its default 50",
    "reproduce C3.1 --jobs 0 --out {folder}": "jobs must be at least 1",
    "reproduce C3.1 --jobs x": "'--jobs'",
    "reproduce C3.1 --out {text}": "Not a directory",
}
MAPS = {
    f"{LATTICE} --map {{map}}": "map does not apply to domain",
    f"{BUILDING} --map missing.yaml": "no such file: missing.yaml",
    f"{BUILDING} --map {LONG}": "no such file",
    f"{BUILDING} --map {{text}}": "is not a map YAML",
    f"{BUILDING} --set start=99,0": "start must be a free place of this map, in metres of its frame; 99,0 lies",
    f"{BUILDING} --set start=1,2,3": "start must be X,Y, two numbers in metres",
    f"{BUILDING} --goal=-1,0": "goal must be a free place",
    f"{BUILDING} --goal attic": "goal: no destination of this building is named 'attic'",
    f"{BUILDING} --goal 1,1 --agent scratch": "agent applies to hidden goals, which are searched",
    f"{BUILDING} --set move_names=true": "move_names applies to goals that are driven to",
    f"{BUILDING} --goals missing.csv": "tasks does not apply with goals",
    "live --memory {known} --map {map} --goals missing.csv": "goals: cannot read missing.csv",
    "live --memory {known} --map {map} --goals {text}": "line 1 must name columns of time, name, x, y",
    f"{BUILDING} --set destinations=5000": "destinations must be at most",
}
PLACES = {
    f"{LATTICE} --log life.mcap": "log as a file applies to domain building, got lattice; give a folder",
    "live --log life.bag": "log must name a file that ends with .mcap or .rrd",
    "memory nav2 {map} --memory {known} --out {folder}": "memory knows no place of the map",
    f"{LATTICE} --out ''": "out must name a folder",
    f"{LATTICE} --out {{text}}": "out must name a folder",
    f"{LATTICE} --out /proc/nowhere": "cannot write into /proc/nowhere",
    f"{LATTICE} --memory ''": "memory must name a file",
    f"{LATTICE} --memory {{text}}": "is not a Lifelore memory",
    f"{LATTICE} --memory {{foreign}}": "belongs to another program",
    f"{LATTICE} --memory {{damaged}}": "is damaged",
    f"{LATTICE} --memory {{newer}}": "newer Lifelore",
    f"{LATTICE} --memory {{text}}/life.db": "check the path",
    f"{LATTICE} --memory {LONG}": "memory ",
    f"{LATTICE} --memory mysql://u:secret@h/d": "memory takes a file or a postgresql:// URL, got mysql://",
    f"{LATTICE} --memory 'postgresql://u:secret@[::1/d'": "this postgresql:// URL cannot be read",
    f"{LATTICE} --memory postgresql://u:secret@127.0.0.1:1/d": "the server cannot be reached",
    "memory show --memory {damaged}": "is damaged",
    "memory export '' --memory {known}": "memory must name a file",
    "memory export {known} --memory {known}": "is a memory in use",
    "memory export {foreign} --memory {known}": "belongs to another program",
    "memory export /proc/nowhere/x --memory {known}": "check the path",
    "memory export postgresql://h/d --memory {known}": "path must be a file",
    "memory import missing.db --memory {known}": "does not exist",
    "memory import {text} --memory {known}": "is not a Lifelore memory",
    "memory import {damaged} --memory {known}": "is damaged",
    "memory merge mysql://h/d --memory {known}": "got mysql://",
    "memory merge missing.db --memory {known}": "does not exist",
}
LOOK = "perceive {cloud} --up z"
SCENES = {
    f"{LOOK} --model nobody --memory {{known}}": "memory has no relation model 'nobody': it has none",
    f"{LOOK} --model nobody --memory {{damaged}}": "is damaged",
}
CASES = ASKED_WRONGLY | NUMBERS | NAMES | MAPS | PLACES | SCENES


def make_things(folder: Path, two_tasks: Path) -> dict[str, Path]:
    """What the cases name; `new` is not made."""
    things = {
        name: folder / f"{name}{ending}"
        for ending, names in {
            ".txt": ["text"], "": ["folder"], ".db": ["new", "known", "foreign", "damaged", "newer"],
            ".yaml": ["map"], ".npz": ["cloud"],
        }.items()
        for name in names
    }  # fmt: skip
    things["text"].write_text("Dear diary,\n" * 500)
    things["folder"].mkdir()
    for name in ("known", "damaged", "newer"):
        shutil.copy(two_tasks, things[name])
    noise = bytearray(things["damaged"].read_bytes())
    noise[4096:] = random.Random(1).randbytes(len(noise) - 4096)
    things["damaged"].write_bytes(noise)
    with closing(sqlite3.connect(things["newer"], isolation_level=None)) as conn:
        conn.execute("INSERT INTO lifelore_migrations VALUES (99, 'flying', 0)")
    with closing(sqlite3.connect(things["foreign"])) as conn:
        conn.execute("CREATE TABLE notes (body TEXT)")
    pixels = np.ones((60, 60), np.uint8)
    pixels[1:-1, 1:-1] = 0
    write_occupancy_map(things["map"], OccupancyMap(pixels, 0.05))
    np.savez(things["cloud"], points=np.eye(3), labels=np.array([2, 2, 3]))
    return things


@pytest.fixture(scope="module")
def things(tmp_path_factory: pytest.TempPathFactory, two_tasks: Path) -> dict[str, Path]:
    return make_things(tmp_path_factory.mktemp("things"), two_tasks)


def everything_in(folder: Path) -> dict[Path, bytes | None]:
    return {path: path.read_bytes() if path.is_file() else None for path in folder.rglob("*")}


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.replace(LONG, "LONG").replace("\n", " ")[:100])
def test_a_mistake_is_one_line_and_loses_nothing(case, things, ask):
    before = everything_in(things["known"].parent)
    said = ask(*shlex.split(case.format(**things)))
    assert CASES[case] in said.refusal
    assert "secret" not in said.err
    # Byte for byte: the sound memory, those that were refused, and no file is left that was not there.
    assert everything_in(things["known"].parent) == before


def test_the_cases_name_only_what_is_made(things):
    named = {part for case in CASES for _, part, _, _ in string.Formatter().parse(case) if part}
    assert named <= set(things)
    with open_memory(things["known"]) as memory:
        assert (memory.tasks("robot"), memory.check()) == (2, [])


def test_odd_bytes_in_an_argument(start, answer):
    """Names need not be UTF-8 on Linux; the line that speaks of them must still be written."""
    said = answer(start("live", "--domain", os.fsdecode(b"\xff\xfe")))
    assert "domain must be one of" in said.refusal
