"""A database and its two kinds of transaction: one writer at a time, readers on a fixed snapshot."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Literal

from sqlalchemy import URL, Connection, Engine, QueuePool, create_engine

from lifelore.core.errors import MissingExtraError, StoreError
from lifelore.memory import schema
from lifelore.memory.location import describe
from lifelore.memory.refusal import BUSY_SECONDS, one_line_refusals
from lifelore.memory.sqlite_file import connect, connect_source, refuse_unless_ours

# Any fixed number, the same for all that write to one database.
_WRITERS_LOCK = schema.APPLICATION_ID


class Store:
    """An open database: `reading` and `writing` are the only doors, and no driver's error leaves them."""

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
        """Give all connections back; harmless when done twice."""
        if self._engine is not None:
            engine, self._engine = self._engine, None
            engine.dispose()

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """A transaction that sees one moment of the database and never waits for writers."""
        with one_line_refusals(self.location), self.engine.connect() as conn:
            if self.is_sqlite:
                conn.exec_driver_sql("BEGIN")
            else:
                conn = conn.execution_options(isolation_level="REPEATABLE READ")
            yield conn
            conn.rollback()

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """A transaction that is alone in writing; all of it is kept or, after any error, nothing."""
        with one_line_refusals(self.location), self.engine.connect() as conn:
            if self.is_sqlite:
                conn.exec_driver_sql("BEGIN IMMEDIATE")
            else:
                conn.exec_driver_sql(f"SET LOCAL lock_timeout = '{BUSY_SECONDS}s'")
                conn.exec_driver_sql(f"SELECT pg_advisory_xact_lock({_WRITERS_LOCK})")
            yield conn
            conn.commit()

    def lies_at(self, place: Path | URL) -> bool:
        """Whether `place` names this very database."""
        if isinstance(place, Path):
            return self.is_sqlite and place.exists() and place.samefile(self.location)
        return not self.is_sqlite and describe(place) == self.location

    def migrate(self) -> None:
        """Take the steps not yet taken, each in a transaction of its own."""
        with self.reading() as conn:
            found = schema.version(conn)
        schema.refuse_newer(self.location, found)
        for number in range(found + 1, schema.LATEST + 1):
            with self.writing() as conn:
                schema.take_step(conn, number)

    def require_current(self) -> None:
        """StoreError unless all steps are taken: the source of a merge is never migrated."""
        with self.reading() as conn:
            found = schema.version(conn)
        schema.refuse_newer(self.location, found)
        if found == 0:
            raise StoreError(f"memory {self.location} holds no Lifelore memory; check the name")
        if found < schema.LATEST:
            raise StoreError(
                f"memory {self.location} is of an older Lifelore (schema {found}); open it once by itself"
            )


def open_file(path: Path, *, durable: bool = False, journal: Literal["WAL", "DELETE"] = "WAL") -> Store:
    """The memory in a file, created with its folders if need be."""
    refuse_unless_ours(path)
    with one_line_refusals(str(path)):
        path.parent.mkdir(parents=True, exist_ok=True)

    def creator():
        conn = connect(path, "rwc")
        conn.execute(f"PRAGMA synchronous = {'FULL' if durable else 'NORMAL'}")
        # What is forgotten is overwritten, not only unlinked; some builds of SQLite leave it otherwise.
        conn.execute("PRAGMA secure_delete = ON")
        return conn

    store = Store(create_engine("sqlite://", creator=creator, poolclass=QueuePool), str(path))
    return _ready(store, journal)


def open_postgresql(url: URL) -> Store:
    """The memory in a PostgreSQL database, created if there is none."""
    return _ready(_server(url), None)


def open_source(place: Path | URL, *, checked: bool = False) -> Store:
    """A memory to read only: never created, migrated or written to; `checked` where `check_source` passed."""
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
    """StoreError unless the file is there and a sound memory."""
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
        # The first step is taken before WAL is switched on, so that the main file says whose it is
        # from its first page on, and a killed beginning is not mistaken for another program's file.
        store.migrate()
        if journal is not None:
            _set_journal(store, journal)
    except BaseException:
        store.close()
        raise
    return store


def _set_journal(store: Store, journal: str) -> None:
    """Switching to WAL needs the file alone for a moment, and SQLite does not wait for that by itself."""
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
