"""`Connection` runs the same SQL text on SQLite and on PostgreSQL; `Pool` holds the open connections of a memory.

The drivers are used directly: a library above them would need most of the time of a start and of a choice.
"""

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from itertools import chain
from typing import Any

Parameters = Sequence[Any]
IDLE = 1.0
"""Seconds after which a connection to a server is tried before its next use; fewer cost a statement more often."""
MANY = 10_000
"""Values in a list of a statement, and rows in a part of a stream: more need more main memory."""


class Connection:
    """A connection of `sqlite3` or `psycopg` that begins and ends transactions by SQL statements.

    Parameters
    ----------
    driver : sqlite3.Connection or psycopg.Connection
        Without transactions of its own.
    is_sqlite : bool
    """

    def __init__(self, driver: Any, *, is_sqlite: bool) -> None:
        self._driver = driver
        self.is_sqlite = is_sqlite
        self.used = time.monotonic()

    def control(self, sql: str) -> None:
        """Begin or end a transaction."""
        self._driver.execute(sql)

    def execute(self, sql: str, parameters: Parameters = ()) -> Any:
        """Run a statement; the cursor gives rows as tuples.

        Parameters are ``?``. The text has no other question mark.
        """
        if self.is_sqlite:
            return self._driver.execute(sql, parameters)
        return self._driver.execute(_for_psycopg(sql), parameters) if parameters else self._driver.execute(sql)

    def execute_many(self, sql: str, rows: Sequence[Parameters]) -> None:
        """Run a statement once for each row of parameters."""
        if self.is_sqlite:
            self._driver.executemany(sql, rows)
        else:
            with self._driver.cursor() as cursor:
                cursor.executemany(_for_psycopg(sql), rows)

    def matching(self, sql: str, values: Sequence[Any], parameters: Sequence[Any] = ()) -> list[tuple[Any, ...]]:
        """All rows of a statement whose ``{many}``, behind its other parameters, stands for a list of values."""
        return self._in_parts(sql, "?", [(value,) for value in values], parameters)

    def matching_rows(self, sql: str, rows: Sequence[Sequence[Any]]) -> list[tuple[Any, ...]]:
        """All rows of a statement whose ``{many}`` stands for rows of values, its only parameters."""
        return self._in_parts(sql, f"({', '.join('?' * len(rows[0]))})", rows) if rows else []

    def _in_parts(
        self, sql: str, places: str, rows: Sequence[Sequence[Any]], parameters: Sequence[Any] = ()
    ) -> list[tuple[Any, ...]]:
        found: list[tuple[Any, ...]] = []
        step = MANY // places.count("?")
        for at in range(0, len(rows), step):
            part = rows[at : at + step]
            text = sql.replace("{many}", ", ".join([places] * len(part)))
            found += self.execute(text, [*parameters, *chain.from_iterable(part)]).fetchall()
        return found

    def insert(self, table: str, columns: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
        """Insert new rows; PostgreSQL copies them."""
        if self.is_sqlite:
            self._insert_values(table, columns, rows, "")
            return
        with self._driver.cursor().copy(f"COPY {table} ({', '.join(columns)}) FROM STDIN") as copy:
            for row in rows:
                copy.write_row(row)

    def insert_unless_there(
        self, table: str, types: Mapping[str, str], rows: Sequence[Sequence[Any]], key: str, returning: str
    ) -> list[tuple[Any, ...]]:
        """Insert those of the rows whose `key` is new; columns of the inserted rows.

        Parameters
        ----------
        types : mapping of str to str
            Names of the columns, and their types on PostgreSQL.
        key, returning : str
            Columns with commas between.
        """
        also = f"ON CONFLICT ({key}) DO NOTHING RETURNING {returning}"
        if self.is_sqlite:
            return self._insert_values(table, list(types), rows, also)
        statement = f"INSERT INTO {table} ({', '.join(types)}) SELECT * FROM {_unnested(types)} {also}"
        return self.execute(statement, _columns(rows)).fetchall()

    def _insert_values(
        self, table: str, columns: Sequence[str], rows: Sequence[Sequence[Any]], also: str
    ) -> list[tuple[Any, ...]]:
        """Insert rows by statements of many, for SQLite; all that they return."""
        return self.matching_rows(f"INSERT INTO {table} ({', '.join(columns)}) VALUES {{many}} {also}", rows)

    def change(
        self, table: str, setting: str, where: str, types: Mapping[str, str], rows: Sequence[Sequence[Any]]
    ) -> None:
        """Update a row of a table for each of `rows`, by one statement where the server takes one.

        Parameters
        ----------
        setting, where : str
            What to set and which row, with the values as ``{name}``.
        types : mapping of str to str
            Names of the values in their order in `rows`, and their types on PostgreSQL.
        """
        if self.is_sqlite:
            places = {name: f"?{number}" for number, name in enumerate(types, 1)}
            statement = f"UPDATE {table} SET {setting.format(**places)} WHERE {where.format(**places)}"
            self._driver.executemany(statement, rows)
        elif rows:
            places = {name: f"v.new_{name}" for name in types}
            given = f"{_unnested(types)} AS v({', '.join(f'new_{name}' for name in types)})"
            statement = (
                f"UPDATE {table} SET {setting.format(**places)} FROM {given} WHERE {where.format(**places)}"
            )
            self.execute(statement, _columns(rows))

    def stream(self, sql: str, parameters: Sequence[Any] = ()) -> Iterator[list[tuple[Any, ...]]]:
        """The rows of a statement in parts of bounded size, inside a transaction."""
        if self.is_sqlite:
            cursor = self.execute(sql, parameters)
        else:
            cursor = self._driver.cursor(name="lifelore_stream")
            cursor.execute(_for_psycopg(sql), parameters)
        try:
            while rows := cursor.fetchmany(MANY):
                yield rows
        finally:
            cursor.close()

    def first(self, sql: str, parameters: Parameters = ()) -> tuple[Any, ...] | None:
        """The first row; None where there is none."""
        # All rows are read, because a statement in progress would keep the transaction from its end.
        rows = self.execute(sql, parameters).fetchall()
        return rows[0] if rows else None

    def value(self, sql: str, parameters: Parameters = ()) -> Any:
        """The first column of the first row, which there must be."""
        return self.execute(sql, parameters).fetchall()[0][0]

    def answers(self) -> bool:
        """Whether the server still answers; a server may have been started again since the last use."""
        if self.is_sqlite or time.monotonic() - self.used < IDLE:
            return True
        try:
            self.control("SELECT 1")
        except Exception:
            return False
        return True

    def close(self) -> None:
        """Close the connection; what is not committed is lost."""
        self._driver.close()


def _unnested(types: Mapping[str, str]) -> str:
    """The rows whose columns are given as lists, for PostgreSQL."""
    return f"unnest({', '.join(f'CAST(? AS {kind}[])' for kind in types.values())})"


def _columns(rows: Iterable[Sequence[Any]]) -> list[list[Any]]:
    return [list(column) for column in zip(*rows, strict=True)]


@cache
def _for_psycopg(sql: str) -> str:
    """`sql` with psycopg's ``%s`` in place of ``?``."""
    return sql.replace("%", "%%").replace("?", "%s")


class Pool:
    """Connections that wait for their next use; one that met an error is closed.

    Parameters
    ----------
    connect : callable
        Opens another connection.
    """

    def __init__(self, connect: Callable[[], Connection]) -> None:
        self._connect = connect
        self._waiting: list[Connection] = []

    @contextmanager
    def connection(self) -> Iterator[Connection]:
        """A connection that no other thread uses in the meantime."""
        conn = self._taken()
        try:
            yield conn
        except BaseException:
            conn.close()
            raise
        conn.used = time.monotonic()
        self._waiting.append(conn)

    def _taken(self) -> Connection:
        """A waiting connection that answers, or a new one."""
        while True:
            try:
                conn = self._waiting.pop()
            except IndexError:
                return self._connect()
            if conn.answers():
                return conn
            conn.close()

    def close(self) -> None:
        """Close the waiting connections."""
        while self._waiting:
            self._waiting.pop().close()
