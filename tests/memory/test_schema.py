"""Numbered steps: each with its note or not at all, and a newer memory is refused."""

import numpy as np
import pytest

from lifelore.core import Record, StoreError
from lifelore.memory import open_memory, schema
from lifelore.memory.studies import TABLES
from lifelore.memory.study_rows import DecisionRow

NOW = sorted(schema.MIGRATIONS)
STUDIES = ("lifelore_studies", *TABLES)


@pytest.fixture
def next_schema(monkeypatch):
    """A later Lifelore, with one step more than this one."""

    def with_step(statements: str) -> int:
        number = schema.LATEST + 1
        monkeypatch.setattr(schema, "MIGRATIONS", schema.MIGRATIONS | {number: ("a test", statements)})
        monkeypatch.setattr(schema, "LATEST", number)
        return number

    return with_step


def steps(memory) -> list[int]:
    with memory._store.reading() as conn:
        return [row[0] for row in conn.execute("SELECT number FROM lifelore_migrations ORDER BY number")]


def test_an_older_memory_takes_the_missing_steps(where, next_schema):
    with open_memory(where) as memory:
        memory.contribute("a", [], process="p", seq=0, task={})
        assert steps(memory) == NOW
    number = next_schema("ALTER TABLE lifelore_contributions ADD COLUMN note {text}")
    with open_memory(where) as memory:
        assert steps(memory) == [*NOW, number]
        assert (memory.tasks("a"), memory.show()["schema"]) == (1, number)
        assert memory.contribute("a", [], process="p", seq=1, task={})
    with open_memory(where) as memory:
        assert steps(memory) == [*NOW, number]


def fill(memory):
    weights = Record("prior", "b7", 1, "add", np.array([4, 2]), np.array([10, 30]))
    assert memory.contribute("a", [weights], process="p", seq=0, task={})


def test_a_memory_of_the_sixth_schema_gets_studies(where, monkeypatch):
    with monkeypatch.context() as before:
        before.setattr(schema, "MIGRATIONS", {6: schema.MIGRATIONS[6]})
        before.setattr(schema, "LATEST", 6)
        with open_memory(where) as memory:
            fill(memory)
            with memory._store.writing() as conn:  # as a learner's state was stored
                lore = conn.value("SELECT number FROM lifelore_lore")
                state = "INSERT INTO lifelore_cells (lore, slot, value, origin, state) VALUES (?, 0, 7, 1, ?)"
                conn.execute(state, (-lore, b"state"))
            assert (steps(memory), memory.show()["schema"]) == ([6], 6)
            with memory._store.reading() as conn, pytest.raises(Exception, match="lifelore_studies"):
                conn.execute("SELECT * FROM lifelore_studies")
    with open_memory(where) as memory:
        assert steps(memory) == NOW
        with memory._store.reading() as conn:
            assert conn.value("SELECT COUNT(*) FROM lifelore_cells WHERE lore < 0") == 0
        assert (memory.tasks("a"), memory.recall("prior", "b7", 1).values.tolist()) == (1, [30, 10])
        assert memory.check() == []
        number = memory.studies.keep("s", {"rule": "best"}, b"library").number
        with memory.studies.writing(number) as rows:
            rows.add_users([("eva", None, None)], 0)
            person = rows.users(["eva"])["eva"].number
            rows.add_decisions([DecisionRow(bytes(16), person, "dark", 0.25, False, 1, 0, None)])
        with memory.studies.reading(number) as rows:
            assert rows.decisions_of([person])[person][0].policy == "dark"
    with open_memory(where) as memory:
        assert (memory.studies.newest("s").content, memory.studies.states()) == (b"library", {"s": "active"})


def test_keys_beside_contributions_become_mentions(file, monkeypatch):
    """Schemas 4 to 8 kept the key of a contribution's only record beside the contribution."""
    with monkeypatch.context() as before:
        before.setattr(schema, "MIGRATIONS", {number: schema.MIGRATIONS[number] for number in range(6, 9)})
        before.setattr(schema, "LATEST", 8)
        with open_memory(file) as memory:
            fill(memory)
            with memory._store.writing() as conn:
                conn.execute("UPDATE lifelore_contributions SET lore = (SELECT number FROM lifelore_lore)")
                conn.execute("DELETE FROM lifelore_mentions")
    with pytest.raises(StoreError, match="lifelore memory show"):
        open_memory(file, read_only=True)
    with open_memory(file) as memory:
        assert (memory.check(), steps(memory)) == ([], NOW)
        assert memory.forget_records([("prior", "b7", 1)]) == 1


def test_decisions_without_turns_are_counted(where, monkeypatch):
    """Schemas 7 to 9 kept no turn of a decision."""
    with monkeypatch.context() as before:
        before.setattr(schema, "MIGRATIONS", {number: schema.MIGRATIONS[number] for number in range(6, 10)})
        before.setattr(schema, "LATEST", 9)
        with open_memory(where) as memory, memory._store.writing() as conn:
            user = "1, 1, 'eva', 0, 0, 0, 0.0, 0, 0.0"
            columns = "number, study, name, fitted, version, personal, personal_sum, control, control_sum"
            override = "" if conn.is_sqlite else "OVERRIDING SYSTEM VALUE"
            conn.execute(f"INSERT INTO lifelore_study_users ({columns}) {override} VALUES ({user})")
            columns = ("study", "id", "person", "policy", "probability", "control", "version", "time")
            rows = [(1, bytes([place] * 16), 1, "dark", 0.5, 0, 1, 0) for place in range(2)]
            conn.insert("lifelore_decisions", columns, rows)
    with open_memory(where) as memory, memory.studies.writing(1) as rows:
        assert rows.users(["eva"], count=True)["eva"].n_decisions == 2
        rows.add_decisions([DecisionRow(bytes([9] * 16), 1, "dark", 0.5, False, 1, 0, turn=2)])
        assert rows.users(["eva"], count=True)["eva"].n_decisions == 3


def test_a_step_that_fails_leaves_nothing_behind(where, next_schema, monkeypatch):
    with open_memory(where) as memory:
        memory.contribute("a", [], process="p", seq=0, task={})
    with monkeypatch.context() as patch:
        patch.setattr(schema, "LATEST", schema.LATEST + 1)
        patch.setattr(
            schema,
            "MIGRATIONS",
            schema.MIGRATIONS | {schema.LATEST: ("bad", "CREATE TABLE half (x {int}); NONSENSE")},
        )
        with pytest.raises(StoreError) as refused:
            open_memory(where)
    assert "\n" not in str(refused.value)
    with open_memory(where) as memory:
        assert (steps(memory), memory.tasks("a")) == (NOW, 1)
        with memory._store.reading() as conn, pytest.raises(Exception, match="half"):
            conn.execute("SELECT * FROM half")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("INSERT INTO lifelore_migrations VALUES (99, 'flying', 0)", "newer Lifelore"),
        ("UPDATE lifelore_migrations SET number = number - 5", "early Lifelore"),
    ],
)
def test_a_newer_memory_and_one_too_old_are_refused(where, change, words):
    with open_memory(where) as memory:
        memory.contribute("a", [], process="p", seq=0, task={})
        with memory._store.writing() as conn:
            conn.execute(change)
    with pytest.raises(StoreError, match=words):
        open_memory(where)


@pytest.mark.parametrize(("number", "readable"), [(8, False), (9, True)])
def test_an_older_source_is_not_migrated_behind_its_back(number, readable, file, tmp_path, monkeypatch):
    with monkeypatch.context() as before:
        before.setattr(schema, "MIGRATIONS", {one: schema.MIGRATIONS[one] for one in range(6, number + 1)})
        before.setattr(schema, "LATEST", number)
        with open_memory(file) as memory:
            fill(memory)
            made = memory.studies.keep("s", {"rule": "best"}, b"library").number
    content = file.read_bytes()
    with open_memory(tmp_path / "new.db") as memory:
        if readable:
            assert memory.merge_from(file)["added"] == 1
            with open_memory(file, read_only=True) as source, source.studies.reading(made) as rows:
                assert rows.decisions_of([1]) == {}
        else:
            with pytest.raises(StoreError, match="older Lifelore"):
                memory.merge_from(file)
    assert file.read_bytes() == content
