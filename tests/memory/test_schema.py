"""Numbered steps: each with its note or not at all, and a newer memory is refused."""

import pytest
from sqlalchemy import text

from lifelore.core.errors import StoreError
from lifelore.memory import open_memory, schema


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
        return list(conn.execute(text("SELECT number FROM lifelore_migrations ORDER BY number")).scalars())


def test_an_older_memory_takes_the_missing_steps(where, next_schema):
    with open_memory(where) as memory:
        memory.contribute("a", [], process="p", seq=0, task={})
        assert steps(memory) == [1, 2]
    number = next_schema("ALTER TABLE lifelore_contributions ADD COLUMN note {text}")
    with open_memory(where) as memory:
        assert steps(memory) == [1, 2, number]
        assert (memory.tasks("a"), memory.show()["schema"]) == (1, number)
        assert memory.contribute("a", [], process="p", seq=1, task={})
    with open_memory(where) as memory:
        assert steps(memory) == [1, 2, number]


def test_a_step_that_fails_leaves_nothing_behind(where, next_schema, monkeypatch):
    with open_memory(where) as memory:
        memory.contribute("a", [], process="p", seq=0, task={})
    with monkeypatch.context() as patch:
        patch.setattr(schema, "LATEST", schema.LATEST + 1)
        bad = {schema.LATEST: ("bad", "CREATE TABLE half (x {int}); NONSENSE")}
        patch.setattr(schema, "MIGRATIONS", schema.MIGRATIONS | bad)
        with pytest.raises(StoreError) as refused:
            open_memory(where)
    assert "\n" not in str(refused.value)
    with open_memory(where) as memory:
        assert (steps(memory), memory.tasks("a")) == ([1, 2], 1)
        with memory._store.reading() as conn, pytest.raises(Exception, match="half"):
            conn.execute(text("SELECT * FROM half"))


def test_a_newer_memory_is_refused(where):
    with open_memory(where) as memory:
        memory.contribute("a", [], process="p", seq=0, task={})
        with memory._store.writing() as conn:
            conn.execute(text("INSERT INTO lifelore_migrations VALUES (99, 'flying', 0)"))
    with pytest.raises(StoreError, match="newer Lifelore"):
        open_memory(where)


def test_an_older_source_is_not_migrated_behind_its_back(file, tmp_path, next_schema):
    open_memory(file).close()
    next_schema("CREATE TABLE lifelore_extra (x {int})")
    before = file.read_bytes()
    with open_memory(tmp_path / "new.db") as memory, pytest.raises(StoreError, match="older Lifelore"):
        memory.merge_from(file)
    assert file.read_bytes() == before
