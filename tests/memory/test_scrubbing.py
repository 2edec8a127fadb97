"""What is forgotten leaves no byte in the file and its log, whoever else has the memory open."""

import hashlib
from pathlib import Path

import numpy as np
import pytest

from lifelore.core import Record, StoreError
from lifelore.memory import open_memory, store

ROBOTS, TASKS = 20, 200


def mark(label: str, seq: int) -> str:
    """A text that does not compress and that no other place has."""
    return hashlib.sha256(f"{label} {seq}".encode()).hexdigest()


def contribute(memory, robot: str, seq: int) -> None:
    """All that a contribution can carry: key, description, values and task, each with a mark."""
    key = mark(f"key of {robot}", seq)
    newest = Record("place", key, 1, "newest", [1], [seq], {"note": mark(f"about of {robot}", seq)})
    shared = Record("prior", "shared", 1, "add", np.arange(50), np.full(50, number(robot, seq)))
    task = {"what": mark(f"task of {robot}", seq)}
    assert memory.contribute(robot, [newest, shared], process="p", seq=seq, task=task)


def number(robot: str, seq: int) -> int:
    return int(mark(f"number of {robot}", seq)[:8], 16)


def traces(file: Path, robot: str, seqs: range) -> dict[str, int]:
    """How often the marks of a robot occur in the file and its side files."""
    content = b"".join(side.read_bytes() for side in file.parent.iterdir() if side.name.startswith(file.name))
    labels = ("key", "about", "task")
    return {
        label: sum(content.count(mark(f"{label} of {robot}", seq).encode()) for seq in seqs) for label in labels
    }


@pytest.fixture
def lived(file):
    """A file in which each of some robots has contributed now and then, with pages split all over it."""
    with open_memory(file) as memory:
        for seq in range(TASKS):
            contribute(memory, f"robot {seq % ROBOTS}", seq)
    return file


def test_forgetting_a_robot_leaves_no_byte(lived):
    own = range(7, TASKS, ROBOTS)
    with open_memory(lived) as other, open_memory(lived) as memory:
        assert other.tasks("robot 7") == len(own)
        before = traces(lived, "robot 7", own)
        assert all(count >= len(own) for count in before.values())
        memory.forget("robot 7")
        assert traces(lived, "robot 7", own) == dict.fromkeys(before, 0)
        assert traces(lived, "robot 8", range(8, TASKS, ROBOTS)) == before
        left = [number(f"robot {seq % ROBOTS}", seq) for seq in range(TASKS) if seq % ROBOTS != 7]
        assert other.recall("prior", "shared", 1).values.tolist() == [sum(left)] * 50
        assert memory.check() == []


def test_a_log_that_was_never_moved_is_emptied(file):
    with open_memory(file) as memory:
        contribute(memory, "rosie", 0)
        contribute(memory, "karl", 0)
        assert all(traces(file, "rosie", range(1)).values())
        memory.forget("rosie")
        assert not any(traces(file, "rosie", range(1)).values())
        assert all(traces(file, "karl", range(1)).values())


def test_forgetting_records_leaves_only_their_keys(lived):
    seqs = range(3, 4)
    with open_memory(lived) as memory:
        memory.forget_records([("place", mark("key of robot 3", 3), 1)])
        found = traces(lived, "robot 3", seqs)
        assert found["about"] == 0
        assert found["key"] > 0  # so that no merge brings the record back
        assert found["task"] > 0


def test_a_reader_keeps_the_log_and_the_message_says_so(lived, monkeypatch):
    monkeypatch.setattr(store, "connect", lambda path, access: _impatient(path, access))
    own = range(7, TASKS, ROBOTS)
    with open_memory(lived) as memory, open_memory(lived) as other:
        with other._store.reading() as conn:
            assert conn.value("SELECT COUNT(*) FROM lifelore_contributions") == TASKS
            with pytest.raises(StoreError, match="the content is deleted, but its bytes are still in the log"):
                memory.forget("robot 7")
        assert memory.tasks("robot 7") == 0
        assert any(traces(lived, "robot 7", own).values())
    assert not any(traces(lived, "robot 7", own).values())


def _impatient(path, access):
    from lifelore.memory.sqlite_file import connect

    conn = connect(path, access)
    conn.execute("PRAGMA busy_timeout = 10")
    return conn
