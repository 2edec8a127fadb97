"""Full disks, locks and drivers' complaints: one line, nothing lost."""

import sqlite3
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from lifelore.core import InputError, Record, StoreError
from lifelore.memory import Memory, open_memory, sqlite_file
from lifelore.memory.refusal import one_line_refusals, refusal
from lifelore.memory.sqlite_file import connect


def noise(seq: int) -> Record:
    draw = np.random.default_rng(seq)
    return Record("k", "y", 1, "add", np.unique(draw.integers(0, 2**40, 500)), np.ones(500, dtype=np.int64))


def attempt(memory: Memory, seq: int) -> str | None:
    """Contribute one task; the refusal, if it was refused."""
    try:
        assert memory.contribute("a", [noise(seq)], process="p", seq=seq, task={})
    except StoreError as error:
        return str(error)
    return None


def test_a_full_disk_loses_the_task_in_progress_only(file):
    with open_memory(file) as memory:
        with memory._store.pool.connection() as conn:
            conn.execute("PRAGMA max_page_count = 60")
        stored = 0
        while (refused := attempt(memory, stored)) is None:
            stored += 1
        assert "no space is left" in refused
        assert "\n" not in refused
        assert 0 < stored == memory.tasks("a")
        assert memory.check() == []
        with memory._store.pool.connection() as conn:
            conn.execute("PRAGMA max_page_count = 6000")
        assert memory.contribute("a", [noise(stored)], process="p", seq=stored, task={})
        assert memory.check() == []


def test_a_locked_file_is_given_up_in_the_end(file, monkeypatch):
    open_memory(file).close()
    monkeypatch.setattr(sqlite_file, "BUSY_SECONDS", 0.1)
    with closing(connect(file, "rw")) as conn, open_memory(file) as memory:
        conn.execute("BEGIN IMMEDIATE")
        with pytest.raises(StoreError, match="kept it locked"):
            memory.contribute("a", [], process="p", seq=0, task={})
        assert memory.tasks("a") == 0
        conn.execute("ROLLBACK")
        assert memory.contribute("a", [], process="p", seq=0, task={})


def test_a_broken_database_is_one_line(memory):
    with memory._store.writing() as conn:
        conn.execute("DROP TABLE lifelore_cells")
    with pytest.raises(StoreError, match="lifelore_cells") as refused:
        memory.contribute("a", [noise(0)], process="p", seq=0, task={})
    assert "\n" not in str(refused.value)
    assert memory.tasks("a") == 0


def test_an_interrupt_changes_nothing(memory, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("lifelore.memory.memory.cache.write", interrupt)
        with pytest.raises(KeyboardInterrupt):
            memory.contribute("a", [noise(0)], process="p", seq=0, task={})
    assert memory.tasks("a") == 0
    assert memory.contribute("a", [noise(0)], process="p", seq=0, task={})


def test_our_own_errors_pass_and_system_errors_are_named():
    with pytest.raises(InputError), one_line_refusals("here"):
        raise InputError("mine")
    with pytest.raises(StoreError, match=r"^mine$"), one_line_refusals("here"):
        raise StoreError("mine")
    with pytest.raises(StoreError, match=r"^memory here: "), one_line_refusals("here"):
        Path("/nowhere/at/all").read_bytes()


def test_the_message_is_one_short_line():
    message = str(refusal("here", sqlite3.OperationalError("first\nsecond\n" + "x" * 1000)))
    assert message.startswith("memory here: first second x")
    assert len(message) < 250
