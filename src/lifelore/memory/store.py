"""`Store`: an open database with transactions for one writer at a time, and for readers on a snapshot."""

import sqlite3
import threading
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Any, Literal

from lifelore.core.errors import StoreError
from lifelore.memory import schema
from lifelore.memory.connection import Connection, Pool
from lifelore.memory.location import Server, default_path, describe
from lifelore.memory.refusal import BUSY_SECONDS, one_line_refusals
from lifelore.memory.sqlite_file import connect, connect_source, is_writable, refuse_unless_ours

REWRITTEN = 64 << 20
"""Bytes of a file that is written anew after rows are forgotten, some 100 MB/s; of a larger file `VACUUM` is left
to its owner."""
CACHE_KIB = 32 * 1024
"""KiB of pages that a connection to an SQLite file keeps; more makes large studies faster."""
_TEMPORARY = {False: "PRAGMA temp_store = FILE", True: "PRAGMA temp_store = MEMORY"}
"""By whether a transaction changes few rows: where SQLite keeps pages of a part that may be undone, and sorts. A
file makes a new row of a study cost a third more; reports and merges of any size stay out of main memory."""
# Any fixed number, the same for all processes that write to a database.
_WRITERS_LOCK = schema.APPLICATION_ID


class Store:
    """An open database; `reading` and `writing` give transactions and convert the driver's errors."""

    def __init__(self, pool: Pool, location: str, *, is_sqlite: bool) -> None:
        self._pool: Pool | None = pool
        self.location = location
        self.is_sqlite = is_sqlite
        self._own = threading.local()

    @property
    def pool(self) -> Pool:
        """The connections; StoreError after `close`."""
        if self._pool is None:
            raise StoreError(f"memory {self.location} is closed; open it again")
        return self._pool

    def close(self) -> None:
        """Close all connections; a second call does nothing."""
        if self._pool is not None:
            pool, self._pool = self._pool, None
            pool.close()

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """A transaction on a snapshot of the database, which never waits for writers."""
        if (joint := self._joint) is not None:
            with one_line_refusals(self.location):
                yield joint
            return
        with one_line_refusals(self.location), self.pool.connection() as conn:
            if self.is_sqlite:
                conn.control(_TEMPORARY[False])
            conn.control("BEGIN" if self.is_sqlite else "BEGIN ISOLATION LEVEL REPEATABLE READ")
            yield conn
            conn.control("ROLLBACK")

    @contextmanager
    def writing(self, *, rows: bool = False) -> Iterator[Connection]:
        """A writing transaction; it is committed completely, or after an error not at all.

        Parameters
        ----------
        rows : bool
            Whether it locks the rows that it changes by itself. On PostgreSQL several such transactions run at the
            same time; every other one is the only one. SQLite has one writer at a time.
        """
        if (joint := self._joint) is not None:
            with one_line_refusals(self.location):
                joint.control("SAVEPOINT lifelore_part")
                try:
                    yield joint
                except BaseException:
                    joint.control("ROLLBACK TO SAVEPOINT lifelore_part")
                    raise
                joint.control("RELEASE SAVEPOINT lifelore_part")
            return
        with one_line_refusals(self.location), self.pool.connection() as conn:
            if self.is_sqlite:
                conn.control(_TEMPORARY[rows])
                conn.control("BEGIN IMMEDIATE")
            else:
                wait = f"SET LOCAL lock_timeout = '{BUSY_SECONDS}s'"
                alone = "" if rows else f"; SELECT pg_advisory_xact_lock({_WRITERS_LOCK})"
                conn.control(f"BEGIN; {wait}{alone}")
            yield conn
            conn.control("COMMIT")

    def empty_log(self) -> None:
        """Move the log of an SQLite file into the file and empty it; does nothing on a PostgreSQL server.

        SQLite overwrites deleted rows and freed pages by zeros (``secure_delete``), but the log has earlier copies
        of these pages until it is emptied. Where rows have moved to other pages, copies of them may stay in the
        unused parts of pages: a file of up to `REWRITTEN` bytes is written anew without them.

        Raises
        ------
        StoreError
            Another process has been reading for `BUSY_SECONDS`.
        """
        if not self.is_sqlite:
            return
        if self._joint is not None:  # the log can be emptied once the block is stored
            self._own.log_to_empty = True
            return
        with one_line_refusals(self.location), self.pool.connection() as conn:
            if conn.value("PRAGMA page_count") * conn.value("PRAGMA page_size") <= REWRITTEN:
                _rewrite(conn)
            if conn.value("PRAGMA wal_checkpoint(TRUNCATE)"):
                raise StoreError(
                    f"memory {self.location}: the content is deleted, but its bytes are still in the log, which "
                    f"another process has read for {BUSY_SECONDS} s; they go when all have closed the memory"
                )

    @contextmanager
    def together(self, *, rows: bool = False) -> Iterator[None]:
        """A single transaction, as `writing`, for all that this thread reads and writes inside the block."""
        with self.writing(rows=rows) as conn:
            self._own.joint = conn
            try:
                yield
            finally:
                self._own.joint = None
        if getattr(self._own, "log_to_empty", False):
            self._own.log_to_empty = False
            self.empty_log()

    @property
    def _joint(self) -> Connection | None:
        return getattr(self._own, "joint", None)

    def lies_at(self, place: Path | Server) -> bool:
        """Whether `place` is the location of this database."""
        if isinstance(place, Path):
            return self.is_sqlite and place.exists() and place.samefile(self.location)
        return not self.is_sqlite and describe(place) == self.location

    def migrate(self) -> None:
        """Run the missing migrations, each in its own transaction."""
        with self.reading() as conn:
            found = schema.version(conn)
        schema.refuse_unknown(self.location, found)
        for number in schema.MIGRATIONS:
            if number > found:
                with self.writing() as conn:
                    schema.take_step(conn, number)

    def require_memory(self) -> int:
        """The number of the memory's last migration; StoreError if the database holds no memory."""
        with self.reading() as conn:
            found = schema.version(conn)
        schema.refuse_unknown(self.location, found)
        if found == 0:
            raise StoreError(f"memory {self.location} holds no Lifelore memory; check the name")
        return found

    def require_current(self) -> None:
        """Raise StoreError unless the memory can be read as it is: one that is only read is never changed."""
        found = self.require_memory()
        if found < schema.READABLE:
            raise StoreError(
                f"memory {self.location} is of an older Lifelore (schema {found});"
                " update it by lifelore memory show"
            )


def _rewrite(conn: Connection) -> None:
    """Write a file of SQLite anew, unless another connection is at work in it just now."""
    conn.control("PRAGMA busy_timeout = 100")
    try:
        with suppress(sqlite3.OperationalError):
            conn.control("VACUUM")
    finally:
        conn.control(f"PRAGMA busy_timeout = {1000 * BUSY_SECONDS}")


def open_file(path: Path, *, durable: bool = False, journal: Literal["WAL", "DELETE"] = "WAL") -> Store:
    """Open the memory in a file; create it if it is missing, and the folder of the user's own memory."""
    refuse_unless_ours(path)
    if path == default_path():
        with one_line_refusals(str(path)):
            path.parent.mkdir(parents=True, exist_ok=True)
    elif not path.parent.exists():
        raise StoreError(f"memory: the folder {path.parent} does not exist; create it, or check the path")

    def writable() -> Connection:
        conn = connect(path, "rwc")
        conn.execute(f"PRAGMA synchronous = {'FULL' if durable else 'NORMAL'}")
        # Overwrite forgotten content; some builds of SQLite would only unlink it.
        conn.execute("PRAGMA secure_delete = ON")
        conn.execute(f"PRAGMA cache_size = {-CACHE_KIB}")
        return Connection(conn, is_sqlite=True)

    return _ready(Store(Pool(writable), str(path), is_sqlite=True), journal)


def open_postgresql(server: Server) -> Store:
    """Open the memory in a PostgreSQL database; create it if there is none."""
    return _ready(_server(server), None)


def open_existing(place: Path | Server, *, durable: bool = False) -> Store:
    """Open a memory that exists; only for reading if its file or folder cannot be written."""
    if isinstance(place, Path):
        check_source(place)
        if not is_writable(place):
            return open_source(place, checked=True)
    with closing(_source_file(place) if isinstance(place, Path) else _server(place)) as found:
        found.require_memory()
    return open_file(place, durable=durable) if isinstance(place, Path) else open_postgresql(place)


def open_source(place: Path | Server, *, checked: bool = False) -> Store:
    """Open a memory for reading only; `checked`: `check_source` has passed. It is never created or changed."""
    if isinstance(place, Path) and not checked:
        check_source(place)
    store = _source_file(place) if isinstance(place, Path) else _server(place)
    try:
        store.require_current()
    except BaseException:
        store.close()
        raise
    return store


def check_source(path: Path) -> None:
    """Raise StoreError unless the file exists and is a sound memory."""
    if not path.exists():
        raise StoreError(f"memory {path} does not exist; check the path")
    refuse_unless_ours(path)


def _source_file(path: Path) -> Store:
    return Store(Pool(lambda: Connection(connect_source(path), is_sqlite=True)), str(path), is_sqlite=True)


def _server(server: Server) -> Store:
    import psycopg

    def connection() -> Connection:
        options: dict[str, Any] = {"connect_timeout": BUSY_SECONDS} | server.options
        return Connection(psycopg.connect(autocommit=True, **options), is_sqlite=False)

    return Store(Pool(connection), server.location, is_sqlite=False)


def _ready(store: Store, journal: str | None) -> Store:
    try:
        # The first migration runs before WAL is switched on, so that the main file has its application id even
        # if the process is killed now; otherwise it would seem another program's file.
        store.migrate()
        if journal is not None:
            _set_journal(store, journal)
    except BaseException:
        store.close()
        raise
    return store


def _set_journal(store: Store, journal: str) -> None:
    """Set the journal mode; retry, because WAL needs the file exclusively and SQLite does not wait for it."""
    give_up = time.monotonic() + BUSY_SECONDS
    while True:
        try:
            with one_line_refusals(store.location), store.pool.connection() as conn:
                if conn.value("PRAGMA journal_mode") != journal.lower():
                    conn.value(f"PRAGMA journal_mode = {journal}")
                return
        except StoreError as error:
            if "locked" not in str(error) or time.monotonic() > give_up:
                raise
            time.sleep(0.01)
