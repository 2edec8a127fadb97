"""Files that are not a sound memory of ours are refused in one line and left as they are, byte by byte."""

import os
import random
import shutil
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from lifelore.core import Record, StoreError
from lifelore.memory import open_memory
from lifelore.memory.sqlite_file import connect, is_in_use, read_header


def fill(path: Path, tasks: int = 20) -> Path:
    ones = np.ones(2000, dtype=np.int64)
    with open_memory(path) as memory:
        for seq in range(tasks):
            noise = np.random.default_rng(seq).integers(0, 2**40, 2000)
            records = [
                Record("k", "y", 1, "add", np.arange(2000), ones),
                Record("k", "z", 1, "union", np.arange(2000), noise),
            ]
            memory.contribute("a", records, process="p", seq=seq, task={})
    return path


def refused(path: Path) -> str:
    """The message of the refusal, after a check that neither file nor folder changed."""
    before, names = path.read_bytes(), sorted(os.listdir(path.parent))
    with pytest.raises(StoreError) as error:
        open_memory(path)
    with open_memory(path.parent.parent / f"{path.parent.name}-other.db") as other, pytest.raises(StoreError):
        other.merge_from(path)
    assert path.read_bytes() == before
    assert sorted(os.listdir(path.parent)) == names
    assert "\n" not in str(error.value)
    assert str(path) in str(error.value)
    return str(error.value)


@pytest.mark.parametrize(
    "content",
    [b"x", b"Dear diary,\n" * 500, b"SQLite format 3\0", random.Random(1).randbytes(8192), bytes(8192)],
    ids=["one byte", "text", "magic only", "random", "zeros"],
)
def test_a_file_that_is_no_database(file, content):
    file.write_bytes(content)
    assert "not a Lifelore memory" in refused(file)


@pytest.mark.parametrize("journal", ["DELETE", "WAL"])
def test_another_programs_database(file, journal):
    with closing(sqlite3.connect(file)) as conn:
        conn.execute(f"PRAGMA journal_mode = {journal}")
        conn.execute("CREATE TABLE notes (body TEXT)")
        conn.commit()
    assert "another program" in refused(file)


@pytest.mark.slow
@pytest.mark.parametrize("kept", [99, 100, 4096, 5000, 0.5, -4096, -1])
def test_a_file_cut_short(file, kept):
    size = fill(file).stat().st_size
    os.truncate(file, int(size * kept) if isinstance(kept, float) else kept % size)
    assert "damaged" in refused(file)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_pages_overwritten_at_random(file, seed):
    """All inner nodes of the trees: an overwritten page of a blob's content is found by `check` alone."""
    draw = random.Random(seed)
    pages = fill(file).stat().st_size // 4096
    content = bytearray(file.read_bytes())
    for page in draw.sample(range(1, pages), pages // 2):
        content[page * 4096 : (page + 1) * 4096] = draw.randbytes(4096)
    file.write_bytes(content)
    assert "damaged" in refused(file)


@pytest.mark.slow
def test_a_newer_file(file):
    fill(file)
    with closing(connect(file, "rw")) as conn:
        conn.execute("INSERT INTO lifelore_migrations VALUES (99, 'flying', 0)")
    assert "newer Lifelore (schema 99" in refused(file)


def test_a_folder(tmp_path):
    with pytest.raises(StoreError, match="is a folder"):
        open_memory(tmp_path)


def test_a_file_where_a_folder_should_be(file):
    file.write_text("no folder")
    with pytest.raises(StoreError) as error:
        open_memory(file / "lifelore.db")
    assert "\n" not in str(error.value)


@pytest.mark.slow
def test_an_empty_file_is_a_new_memory(file):
    file.touch()
    assert len(fill(file).read_bytes()) > 0


def test_a_copy_of_a_file_and_its_log_is_whole(file, tmp_path):
    """What another process has not yet moved from the log to the file is not taken for damage."""
    copy = tmp_path / "copy.db"
    with open_memory(file) as memory:
        memory.contribute("a", [], process="p", seq=0, task={})
        for ending in ("", "-wal"):
            shutil.copy(f"{file}{ending}", f"{copy}{ending}")
    with open_memory(copy) as memory:
        assert memory.tasks("a") == 1


@pytest.mark.slow
def test_a_memory_is_lived_in_once_opened(file, tmp_path):
    with open_memory(fill(file)) as memory:
        memory.export_to(tmp_path / "export.db")
    assert is_in_use(read_header(file))
    assert not is_in_use(read_header(tmp_path / "export.db"))


AS_NOBODY = """
import os, sys
from lifelore.core.errors import StoreError
from lifelore.memory import open_memory
path, use = sys.argv[1:]
open_memory(path).close()  # all that is imported late is imported before the rights are given up
if use != "file":
    os.chmod(os.path.dirname(path), 0o555)
if use != "folder":
    os.chmod(path, 0o444)
if os.getuid() == 0:
    os.setgid(65534), os.setuid(65534)
try:
    with open_memory(path) as memory:
        print("tasks", memory.tasks("a"))
        memory.contribute("b", [], process="q", seq=0, task={})
except StoreError as error:
    print("refused:", error)
"""


@pytest.mark.slow
@pytest.mark.parametrize("use", ["file", "folder", "both"])
def test_read_only_is_refused_in_one_line(file, use, tmp_path):
    for folder in [tmp_path, *tmp_path.parents][:-2]:  # below /tmp; pytest closes its folders to other users
        folder.chmod(0o755)
    before = fill(file).read_bytes()
    done = subprocess.run([sys.executable, "-c", AS_NOBODY, str(file), use], capture_output=True, text=True)
    tmp_path.chmod(0o755)
    assert done.stderr == ""
    assert done.stdout.splitlines()[-1].startswith(f"refused: memory {file}: it ")
    assert file.read_bytes() == before
    file.chmod(0o644)
    with open_memory(file) as memory:
        assert (memory.tasks("a"), memory.check()) == (20, [])
