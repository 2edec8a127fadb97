"""A SQLite memory as a file: is it ours and sound, and how is it opened. Refused files stay untouched."""

import os
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Literal

from lifelore.core.errors import StoreError
from lifelore.memory.refusal import BUSY_SECONDS, one_line_refusals
from lifelore.memory.schema import APPLICATION_ID, refuse_newer

_MAGIC = b"SQLite format 3\0"
_HEADER = 100
# Every page of a file up to this size is looked at before it is opened (0.2 s for 256 MiB, warm);
# beyond it `Memory.check` does so.
CHECKED_BYTES = 2**28

Access = Literal["ro", "rw", "rwc"]


def connect(path: Path, access: Access, *, immutable: bool = False) -> sqlite3.Connection:
    """A plain connection; transactions are begun and ended by the caller's own statements."""
    uri = f"{path.as_uri()}?mode={access}" + ("&immutable=1" if immutable else "")
    return sqlite3.connect(uri, uri=True, timeout=BUSY_SECONDS, isolation_level=None, check_same_thread=False)


def refuse_unless_ours(path: Path) -> None:
    """Pass for a file that is absent, empty, or a sound memory this program can read.

    Raises
    ------
    StoreError
        A folder, another program's file, a damaged file, or one made by a newer Lifelore.
    """
    with one_line_refusals(str(path)):
        if path.is_dir():
            raise StoreError(f"memory {path} is a folder; name a file in it, such as {path / 'lifelore.db'}")
        if not path.exists() or path.stat().st_size == 0:
            return
        _refuse_foreign(path, read_header(path))
        if not _sidecar(path, "-journal"):
            _refuse_damaged(path)


def read_header(path: Path) -> bytes:
    """The first 100 bytes, fewer if there are no more."""
    with path.open("rb") as file:
        return file.read(_HEADER)


def is_in_use(header: bytes) -> bool:
    """True for a memory that has been opened to live in (WAL), false for a fresh export."""
    return header[18:20] != b"\x01\x01"


def _refuse_foreign(path: Path, header: bytes) -> None:
    if not header.startswith(_MAGIC) or len(header) < _HEADER:
        raise StoreError(
            f"memory {path} is not a Lifelore memory, or is damaged; nothing was changed: name another file"
        )
    if int.from_bytes(header[68:72], "big") != APPLICATION_ID:
        raise StoreError(f"memory {path} belongs to another program; nothing was changed: name another file")


def _refuse_damaged(path: Path) -> None:
    """Look at the file through a connection that cannot write to it."""
    if not _sidecar(path, "-wal"):
        try:
            return _look(path, immutable=True)
        except StoreError:
            # Another process may have begun to write after the test above; only then look again.
            if not _sidecar(path, "-wal"):
                raise
    return _look(path, immutable=False)


def _look(path: Path, *, immutable: bool) -> None:
    with one_line_refusals(str(path)), closing(connect(path, "ro", immutable=immutable)) as conn:
        if conn.execute("SELECT 1 FROM sqlite_master WHERE name = 'lifelore_migrations'").fetchone():
            (found,) = conn.execute("SELECT MAX(number) FROM lifelore_migrations").fetchone()
            refuse_newer(str(path), found or 0)
        (pages,) = conn.execute("PRAGMA page_count").fetchone()
        (page_bytes,) = conn.execute("PRAGMA page_size").fetchone()
        if immutable and path.stat().st_size < pages * page_bytes:
            raise StoreError(f"memory {path} is damaged (cut short); nothing was changed: restore an export")
        if pages * page_bytes <= CHECKED_BYTES:
            (verdict,) = conn.execute("PRAGMA quick_check(1)").fetchone()
            if verdict != "ok":
                said = " ".join(verdict.split())
                raise StoreError(f"memory {path} is damaged ({said}); nothing was changed: restore an export")


def connect_source(path: Path) -> sqlite3.Connection:
    """A connection to read another memory by, which leaves that memory's content as it is."""
    if not is_in_use(read_header(path)):
        return connect(path, "ro")
    if os.access(path, os.W_OK) and os.access(path.parent, os.W_OK):
        # An ordinary connection takes SQLite's locks and tidies its side files away when it closes.
        conn = connect(path, "rw")
        conn.execute("PRAGMA query_only = ON")
        return conn
    return connect(path, "ro", immutable=not _sidecar(path, "-wal"))


def _sidecar(path: Path, ending: str) -> bool:
    side = path.with_name(path.name + ending)
    return side.exists() and side.stat().st_size > 0
