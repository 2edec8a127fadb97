"""Checks and opens the SQLite file of a memory; a file that fails a check is not changed."""

import os
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Literal

from lifelore.core.errors import StoreError
from lifelore.memory.refusal import BUSY_SECONDS, one_line_refusals
from lifelore.memory.schema import APPLICATION_ID, refuse_unknown

_MAGIC = b"SQLite format 3\0"
_JOURNAL_MAGIC = bytes.fromhex("d9d505f920a163d7")
_HEADER = 100
# Largest file of which every page is read and checked before opening (0.1 s for 16 MiB); for larger files use
# `Memory.check`.
CHECKED_BYTES = 2**24

Access = Literal["ro", "rw", "rwc"]


def connect(path: Path, access: Access, *, immutable: bool = False) -> sqlite3.Connection:
    """A connection without implicit transactions; the caller begins and ends them by SQL statements."""
    uri = f"{path.as_uri()}?mode={access}" + ("&immutable=1" if immutable else "")
    return sqlite3.connect(uri, uri=True, timeout=BUSY_SECONDS, isolation_level=None, check_same_thread=False)


def refuse_unless_ours(path: Path) -> None:
    """Check that a file is missing, empty, or a sound memory that this version can read.

    Raises
    ------
    StoreError
        A folder, another program's file, a damaged file, or one made by a newer Lifelore.
    """
    with one_line_refusals(str(path)):
        if path.is_dir():
            raise StoreError(f"memory {path} is a folder; name a file in it, such as {path / 'lifelore.db'}")
        if not path.exists() or path.stat().st_size == 0 or _was_being_made(path):
            return
        _refuse_foreign(path, read_header(path))
        if not _sidecar(path, "-journal"):
            _refuse_damaged(path)


def _was_being_made(path: Path) -> bool:
    """Whether the power failed while the file was made: SQLite then empties it as its journal says."""
    journal = path.with_name(path.name + "-journal")
    if not _sidecar(path, "-journal"):
        return False
    header = read_header(journal)
    return header.startswith(_JOURNAL_MAGIC) and header[16:20] == bytes(4)  # pages before the transaction


def read_header(path: Path) -> bytes:
    """The first 100 bytes of a file, or all if it is shorter."""
    with path.open("rb") as file:
        return file.read(_HEADER)


def is_in_use(header: bytes) -> bool:
    """Whether the memory has been opened for writing (WAL); false for a new export."""
    return header[18:20] != b"\x01\x01"


def _refuse_foreign(path: Path, header: bytes) -> None:
    if not header.startswith(_MAGIC) or len(header) < _HEADER:
        raise StoreError(
            f"memory {path} is not a Lifelore memory, or is damaged; nothing was changed: name another file"
        )
    if int.from_bytes(header[68:72], "big") != APPLICATION_ID:
        raise StoreError(f"memory {path} belongs to another program; nothing was changed: name another file")


def _refuse_damaged(path: Path) -> None:
    """Check the file through a read-only connection."""
    if not _sidecar(path, "-wal"):
        try:
            return _look(path, immutable=True)
        except StoreError:
            # Check again only if another process has begun to write after the test above.
            if not _sidecar(path, "-wal"):
                raise
    return _look(path, immutable=False)


def _look(path: Path, *, immutable: bool) -> None:
    with one_line_refusals(str(path)), closing(connect(path, "ro", immutable=immutable)) as conn:
        if conn.execute("SELECT 1 FROM sqlite_master WHERE name = 'lifelore_migrations'").fetchone():
            (found,) = conn.execute("SELECT MAX(number) FROM lifelore_migrations").fetchone()
            refuse_unknown(str(path), found or 0)
        programs = "SELECT COUNT(*) FROM sqlite_master WHERE type IN ('view', 'trigger')"
        if conn.execute(programs).fetchone()[0]:
            raise StoreError(f"memory {path} has views or triggers, which no Lifelore makes; nothing was changed")
        (pages,) = conn.execute("PRAGMA page_count").fetchone()
        (page_bytes,) = conn.execute("PRAGMA page_size").fetchone()
        if immutable and path.stat().st_size < pages * page_bytes:
            raise StoreError(f"memory {path} is damaged (cut short); nothing was changed: restore an export")
        if pages * page_bytes <= CHECKED_BYTES:
            (verdict,) = conn.execute("PRAGMA quick_check(1)").fetchone()
            if verdict != "ok":
                message = " ".join(verdict.split())
                raise StoreError(f"memory {path} is damaged ({message}); nothing was changed: restore an export")


def is_writable(path: Path) -> bool:
    """Whether SQLite may write the file, and its side files into the folder."""
    return os.access(path, os.W_OK) and os.access(path.parent, os.W_OK)


def connect_source(path: Path) -> sqlite3.Connection:
    """A connection that reads another memory and does not change its content."""
    if not is_in_use(read_header(path)):
        return connect(path, "ro")
    if is_writable(path):
        # An ordinary connection takes SQLite's locks and deletes its side files when it closes.
        conn = connect(path, "rw")
        conn.execute("PRAGMA query_only = ON")
        return conn
    return connect(path, "ro", immutable=not _sidecar(path, "-wal"))


def _sidecar(path: Path, ending: str) -> bool:
    side = path.with_name(path.name + ending)
    return side.exists() and side.stat().st_size > 0
