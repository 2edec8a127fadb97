"""`Store`: an open database with transactions for one writer at a time, and for readers on a snapshot."""

import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Literal

from sqlalchemy import URL, Connection, Engine, QueuePool, create_engine

from lifelore.core.errors import MissingExtraError, StoreError
from lifelore.memory import schema
from lifelore.memory.location import describe
from lifelore.memory.refusal import BUSY_SECONDS, one_line_refusals
from lifelore.memory.sqlite_file import connect, connect_source, is_writable, refuse_unless_ours

# Any fixed number, the same for all processes that write to a database.
_WRITERS_LOCK = schema.APPLICATION_ID


class Store:
    """An open database; `reading` and `writing` give transactions and convert the driver's errors."""

    def __init__(self, engine: Engine, location: str) -> None:
        self._engine: Engine | None = engine
        self.location = location
        self.is_sqlite = engine.dialect.name == "sqlite"

    @property
    def engine(self) -> Engine:
        """The engine; StoreError after `close`."""
        if self._engine is None:
            raise StoreError(f"memory {self.location} is closed; open it again")
        return self._engine

    def close(self) -> None:
        """Close all connections; a second call does nothing."""
        if self._engine is not None:
            engine, self._engine = self._engine, None
            engine.dispose()

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """A transaction on a snapshot of the database, which never waits for writers."""
        with one_line_refusals(self.location), self.engine.connect() as conn:
            if self.is_sqlite:
                conn.exec_driver_sql("BEGIN")
            else:
                conn = conn.execution_options(isolation_level="REPEATABLE READ")
            yield conn
            conn.rollback()

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """The only writing transaction; it is committed completely, or after an error not at all."""
        with one_line_refusals(self.location), self.engine.connect() as conn:
            if self.is_sqlite:
                conn.exec_driver_sql("BEGIN IMMEDIATE")
            else:
                conn.exec_driver_sql(f"SET LOCAL lock_timeout = '{BUSY_SECONDS}s'")
                conn.exec_driver_sql(f"SELECT pg_advisory_xact_lock({_WRITERS_LOCK})")
            yield conn
            conn.commit()

    def lies_at(self, place: Path | URL) -> bool:
        """Whether `place` is the location of this database."""
        if isinstance(place, Path):
            return self.is_sqlite and place.exists() and place.samefile(self.location)
        return not self.is_sqlite and describe(place) == self.location

    def migrate(self) -> None:
        """Run the missing migrations, each in its own transaction."""
        with self.reading() as conn:
            found = schema.version(conn)
        schema.refuse_newer(self.location, found)
        for number in range(found + 1, schema.LATEST + 1):
            with self.writing() as conn:
                schema.take_step(conn, number)

    def require_memory(self) -> int:
        """The number of the memory's last migration; StoreError if the database holds no memory."""
        with self.reading() as conn:
            found = schema.version(conn)
        schema.refuse_newer(self.location, found)
        if found == 0:
            raise StoreError(f"memory {self.location} holds no Lifelore memory; check the name")
        return found

    def require_current(self) -> None:
        """Raise StoreError unless contributions can be read; the source of a merge is never migrated."""
        found = self.require_memory()
        if found < schema.READABLE:
            raise StoreError(
                f"memory {self.location} is of an older Lifelore (schema {found}); open it once by itself"
            )


def open_file(path: Path, *, durable: bool = False, journal: Literal["WAL", "DELETE"] = "WAL") -> Store:
    """Open the memory in a file; create it and its folders if they are missing."""
    refuse_unless_ours(path)
    with one_line_refusals(str(path)):
        path.parent.mkdir(parents=True, exist_ok=True)

    def creator():
        conn = connect(path, "rwc")
        conn.execute(f"PRAGMA synchronous = {'FULL' if durable else 'NORMAL'}")
        # Overwrite forgotten content; some builds of SQLite would only unlink it.
        conn.execute("PRAGMA secure_delete = ON")
        return conn

    store = Store(create_engine("sqlite://", creator=creator, poolclass=QueuePool), str(path))
    return _ready(store, journal)


def open_postgresql(url: URL) -> Store:
    """Open the memory in a PostgreSQL database; create it if there is none."""
    return _ready(_server(url), None)


def open_existing(place: Path | URL, *, durable: bool = False) -> Store:
    """Open a memory that exists; only for reading if its file or folder cannot be written."""
    if isinstance(place, Path):
        check_source(place)
        if not is_writable(place):
            return open_source(place, checked=True)
    with closing(_source_file(place) if isinstance(place, Path) else _server(place)) as found:
        found.require_memory()
    return open_file(place, durable=durable) if isinstance(place, Path) else open_postgresql(place)


def open_source(place: Path | URL, *, checked: bool = False) -> Store:
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
    return Store(create_engine("sqlite://", creator=lambda: connect_source(path), poolclass=QueuePool), str(path))


def _server(url: URL) -> Store:
    options = {} if "connect_timeout" in url.query else {"connect_timeout": BUSY_SECONDS}
    try:
        return Store(create_engine(url, connect_args=options), describe(url))
    except ImportError as error:
        raise MissingExtraError(
            "a postgresql:// memory needs psycopg, which is not installed; pip install 'lifelore[postgres]'"
        ) from error


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
            with one_line_refusals(store.location), store.engine.connect() as conn:
                mode = conn.exec_driver_sql("PRAGMA journal_mode").scalar_one()
                if mode != journal.lower():
                    conn.exec_driver_sql(f"PRAGMA journal_mode = {journal}")
                return
        except StoreError as error:
            if "locked" not in str(error) or time.monotonic() > give_up:
                raise
            time.sleep(0.01)
