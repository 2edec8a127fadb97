"""Converts errors of databases and of the operating system to a `StoreError` of one line."""

import errno
import sqlite3
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from lifelore.core.errors import StoreError

BUSY_SECONDS = 30

_FULL = "no space is left; nothing of this task was stored: free space, then try again"
_READ_ONLY = "it is read-only, nothing was stored: make file and folder writable, or name another memory"
_BUSY = f"another process kept it locked for {BUSY_SECONDS} s; nothing was changed, try again"
_DAMAGED = "it is damaged: restore an export, or move the file away to begin anew"
_CANNOT_OPEN = "it cannot be opened: check the path, and that file and folder may be read and written"
_OVERFLOW = "a value would no longer fit 64 bits; nothing was changed, contribute smaller weights"
_NO_SERVER = "the server cannot be reached or refuses: check host, database, user and password"

# SQLite's error names by their beginning, PostgreSQL's SQLSTATE by its class; the first that fits counts.
_MEANINGS = {
    "SQLITE_FULL": _FULL,
    "SQLITE_READONLY": _READ_ONLY,
    "SQLITE_BUSY": _BUSY,
    "SQLITE_LOCKED": _BUSY,
    "SQLITE_CORRUPT": _DAMAGED,
    "SQLITE_NOTADB": _DAMAGED,
    "SQLITE_CANTOPEN": _CANNOT_OPEN,
    "SQLITE_PERM": _CANNOT_OPEN,
    "SQLITE_IOERR": "the disk failed or is full; nothing of this task was stored: check it, then try again",
    "SQLITE_CONSTRAINT_CHECK": _OVERFLOW,
    "SQLITE_TOOBIG": "the contribution is larger than SQLite takes; nothing was changed, give it in parts",
    "22003": _OVERFLOW,
    "53": _FULL,
    "25006": _READ_ONLY,
    "42501": "the database user may not do this: grant it the right to create and write tables",
    "55P03": _BUSY,
    "08": _NO_SERVER,
    "28": _NO_SERVER,
    "3D": _NO_SERVER,
}

# SQLSTATE of what two transactions at the same moment do to one another.
_RACES = {
    "23505": "another program stored the same at this moment; try again",
    "40": "another program changed the same at this moment; try again",
}

# Error numbers of the operating system for files and folders.
_SYSTEM_ERRORS = {
    errno.ENOSPC: _FULL,
    errno.EDQUOT: _FULL,
    errno.EROFS: _READ_ONLY,
    **dict.fromkeys(
        (errno.ENOENT, errno.ENOTDIR, errno.EEXIST, errno.EACCES, errno.EPERM, errno.ENAMETOOLONG), _CANNOT_OPEN
    ),
}


class RacedError(StoreError):
    """Another transaction was faster; nothing was stored, and the same again may well succeed."""


@contextmanager
def one_line_refusals(location: str) -> Iterator[None]:
    """Convert every error of the drivers inside the block to a StoreError about `location`."""
    try:
        yield
    except _drivers_errors() as error:
        raise refusal(location, error) from error
    except (OSError, MemoryError) as error:
        if isinstance(error, StoreError):
            raise
        raise refusal(location, error) from error


def _drivers_errors() -> tuple[type[Exception], ...]:
    """The errors of SQLite, and of psycopg where it has been imported."""
    psycopg = sys.modules.get("psycopg")
    return (sqlite3.Error, psycopg.Error) if psycopg else (sqlite3.Error,)


def refusal(location: str, cause: BaseException) -> StoreError:
    """The StoreError for a driver's exception: the memory, the meaning, the next step, the driver's message."""
    code = str(getattr(cause, "sqlite_errorname", None) or getattr(cause, "sqlstate", None) or "")
    message = " ".join(str(cause).split())[:200]
    meaning = next((text for start, text in _MEANINGS.items() if code.startswith(start)), None)
    if race := next((text for start, text in _RACES.items() if code.startswith(start)), None):
        return RacedError(f"memory {location}: {race} ({message})")
    if isinstance(cause, OSError):
        meaning = _SYSTEM_ERRORS.get(cause.errno or 0)
    if meaning is None and "connection" in message.lower() and not code:
        meaning = _NO_SERVER
    return StoreError(f"memory {location}: {meaning} ({message})" if meaning else f"memory {location}: {message}")
