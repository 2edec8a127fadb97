"""The page on the format: tables, kinds and versions are those of the code, and its reader agrees with Memory."""

import ast
import contextlib
import io
import re
import sqlite3
from pathlib import Path

import numpy as np

from lifelore.core.protocols import Record
from lifelore.memory import open_memory
from lifelore.memory.schema import MIGRATIONS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "memory_format.md").read_text(encoding="utf-8")
SECTIONS = dict(re.findall(r"^## (.*?)\n(.*?)(?=^## |\Z)", PAGE, flags=re.S | re.M))


def rows(section: str) -> list[list[str]]:
    """Cells of the rows of the first table of a section, without its two lines of head."""
    lines = re.findall(r"^\| ?(.*?) ?\|$", SECTIONS[section], flags=re.M)
    return [[cell.strip() for cell in re.split(r" ?\| ?", line)] for line in lines[2:]]


def test_its_tables_are_those_of_a_new_memory(tmp_path):
    open_memory(tmp_path / "m.db").close()
    with contextlib.closing(sqlite3.connect(tmp_path / "m.db")) as conn:
        names = [name for (name,) in conn.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        made = {
            name: {column[1] for column in conn.execute(f"PRAGMA table_info({name})")}
            for name in names
            if name.startswith("lifelore_")
        }
        assert hex(conn.execute("PRAGMA application_id").fetchone()[0]).upper()[2:] in PAGE
    written: dict[str, set[str]] = {}
    table = ""
    for first, columns, _ in rows("Tables"):
        table = first.strip("`") or table
        written.setdefault(table, set()).update(re.findall(r"`(\w+)`", columns))
    assert written == made


def test_its_versions_are_the_migrations():
    assert rows("Versions of the schema") == [[str(number), name] for number, (name, _) in MIGRATIONS.items()]


def kinds() -> dict[str, tuple[int, str]]:
    """Version and module of each kind: constants that are assigned with ``VERSION``, as ``KIND, VERSION = …``."""
    found = {}
    for path in (ROOT / "src" / "lifelore").rglob("*.py"):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if not (isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Tuple)):
                continue
            names = [name.id for name in node.targets[0].elts if isinstance(name, ast.Name)]
            if names[-1] == "VERSION":
                *values, version = ast.literal_eval(node.value)
                module = path.relative_to(ROOT / "src" / "lifelore").with_suffix("").as_posix().replace("/", ".")
                found |= dict.fromkeys(values, (version, module))
    return found


def test_its_kinds_are_those_of_the_code():
    written = {kind.strip("`"): (1, module.strip("`")) for kind, _, _, module in rows("Kinds of records")}
    assert written == kinds()
    for _, merge, _, _ in rows("Kinds of records"):
        assert merge in ("add", "newest", "union")


def test_its_program_reads_what_memory_recalls(tmp_path, monkeypatch):
    random = np.random.default_rng(3)
    with open_memory(tmp_path / "memory.db") as memory:
        for number in range(12):
            robot = ["rosie", "karl"][number % 2]
            records = []
            for merge in ("add", "newest", "union"):
                slots = random.choice(40, 10, replace=False).astype(np.int64)
                values = random.integers(-5, 100, 10)
                records.append(Record(f"kind {merge}", "k", 1, merge, slots, values, {"of": number}))
            memory.contribute(robot, records, process="p", seq=number, task={"n": number})
        memory.forget_records([("kind add", "k", 1)])
        late = Record("kind add", "k", 1, "add", np.arange(3), np.arange(3))
        memory.contribute("rosie", [late], process="p", seq=99, task={})
        recalled = {kind: memory.recall(kind, "k", 1) for kind in ("kind add", "kind newest", "kind union")}
    (code,) = re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.S | re.M)
    monkeypatch.chdir(tmp_path)
    names: dict = {}
    with contextlib.redirect_stdout(io.StringIO()) as shown:
        exec(code, names)
    cells = names["merged"]("memory.db")
    assert {kind for kind, _, _ in cells} == set(recalled)
    for kind, record in recalled.items():
        assert cells[kind, "k", 1] == dict(zip(record.slots.tolist(), record.values.tolist(), strict=True))
    assert shown.getvalue().splitlines()[0] == "kind add 1 k 3 cells"
