"""The same SQL text in both back ends, and connections that wait for their next use."""

import pytest

from lifelore.memory.connection import Connection, Pool


def test_parameters_go_by_place_in_both_back_ends(memory):
    with memory._store.writing() as conn:
        conn.execute(
            "CREATE TABLE notes (number BIGINT, body TEXT, content " + ("BLOB)" if conn.is_sqlite else "BYTEA)")
        )
        conn.execute("INSERT INTO notes VALUES (?, ?, ?)", (1, "50 %", b"a\0"))
        conn.execute_many("INSERT INTO notes VALUES (?, ?, ?)", [(2**62, "?:x", None), (3, "%s", b"")])
    with memory._store.reading() as conn:
        assert conn.value("SELECT COUNT(*) FROM notes WHERE body LIKE '%x' AND number > ?", (1,)) == 1
        assert conn.first("SELECT number FROM notes WHERE number = ?", (7,)) is None
        rows = list(conn.execute("SELECT number, body, content FROM notes ORDER BY number"))
    assert rows == [(1, "50 %", b"a\0"), (3, "%s", b""), (2**62, "?:x", None)]


class Driver:
    closed = False

    def close(self) -> None:
        self.closed = True


def test_a_connection_is_used_again_unless_it_met_an_error():
    opened: list[Driver] = []

    def connect() -> Connection:
        opened.append(Driver())
        return Connection(opened[-1], is_sqlite=True)

    pool = Pool(connect)
    for _ in range(2):
        with pool.connection() as outer, pool.connection() as inner:
            assert outer is not inner
    assert len(opened) == 2
    with pytest.raises(KeyboardInterrupt), pool.connection():
        raise KeyboardInterrupt
    assert [driver.closed for driver in opened].count(True) == 1
    with pool.connection():
        assert len(opened) == 2
    pool.close()
    assert all(driver.closed for driver in opened)
