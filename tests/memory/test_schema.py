"""Numbered steps: each with its note or not at all, and a newer memory is refused."""

import numpy as np
import pytest

from lifelore.core.errors import StoreError
from lifelore.core.protocols import Record
from lifelore.memory import open_memory, schema

NOW = sorted(schema.MIGRATIONS)


@pytest.fixture
def first_schema():
    """A memory as Lifelore wrote it before forgotten records and states."""

    def make(where, fill):
        with open_memory(where) as memory:
            fill(memory)
            with memory._store.writing() as conn:
                for statement in (
                    "INSERT INTO lifelore_mentions SELECT number, lore FROM lifelore_contributions"
                    " WHERE lore IS NOT NULL",
                    "DROP INDEX lifelore_contributions_lore",
                    "ALTER TABLE lifelore_contributions DROP COLUMN lore",
                    "DELETE FROM lifelore_cells WHERE lore < 0",
                    "ALTER TABLE lifelore_cells DROP COLUMN state",
                    "DROP TABLE lifelore_forgotten_records",
                    "DROP TABLE lifelore_leases",
                ):
                    conn.execute(statement)
                conn.execute("DELETE FROM lifelore_migrations WHERE number > 1")
            assert steps(memory) == [1]

    return make


@pytest.fixture
def next_schema(monkeypatch):
    """A later Lifelore, with one step more than this one."""

    def with_step(statements: str) -> int:
        number = schema.LATEST + 1
        monkeypatch.setattr(schema, "MIGRATIONS", schema.MIGRATIONS | {number: ("a test", statements)})
        monkeypatch.setattr(schema, "LATEST", number)
        monkeypatch.setattr(schema, "READABLE", number)
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


def test_a_memory_of_the_first_schema_gets_states(where, first_schema):
    first_schema(where, fill)
    with open_memory(where) as memory:
        assert memory.recall("prior", "b7", 1).values.tolist() == [30, 10]
        assert memory.recall_state("prior", "b7", 1) == (0, None, {}, None)
        assert memory.check() == []


def test_a_memory_of_the_first_schema_is_read_and_checked_as_it_is(file, first_schema):
    first_schema(file, fill)
    before = file.read_bytes()
    with open_memory(file, read_only=True) as memory:
        known, unknown = memory.recall_states([("prior", "b7", 1), ("prior", "b8", 1)], slots=(3, 9))
        assert (known.token, known.content, known.about, unknown) == (0, None, {}, None)
        assert (known.record.slots.tolist(), known.record.values.tolist()) == ([4], [10])
        assert memory.check() == []
        assert memory.show()["schema"] == 1
    assert file.read_bytes() == before


def test_a_source_of_the_first_schema_is_merged_as_it_is(file, tmp_path, first_schema):
    first_schema(file, fill)
    before = file.read_bytes()
    with open_memory(tmp_path / "new.db") as memory:
        assert memory.merge_from(file)["added"] == 1
        assert memory.recall("prior", "b7", 1).values.tolist() == [30, 10]
    assert file.read_bytes() == before


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


def test_a_newer_memory_is_refused(where):
    with open_memory(where) as memory:
        memory.contribute("a", [], process="p", seq=0, task={})
        with memory._store.writing() as conn:
            conn.execute("INSERT INTO lifelore_migrations VALUES (99, 'flying', 0)")
    with pytest.raises(StoreError, match="newer Lifelore"):
        open_memory(where)


def test_an_older_source_is_not_migrated_behind_its_back(file, tmp_path, next_schema):
    open_memory(file).close()
    next_schema("CREATE TABLE lifelore_extra (x {int})")
    before = file.read_bytes()
    with open_memory(tmp_path / "new.db") as memory, pytest.raises(StoreError, match="older Lifelore"):
        memory.merge_from(file)
    assert file.read_bytes() == before
