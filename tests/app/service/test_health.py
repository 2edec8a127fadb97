"""Health says whether the memory stores, and to nobody where the memory is."""

import logging
import sqlite3

import pytest

from lifelore.app.service import health_routes
from lifelore.core.errors import StoreError
from lifelore.memory import open_memory


@pytest.fixture(autouse=True)
def always(monkeypatch):
    monkeypatch.setattr(health_routes, "EVERY", 0.0)


def test_a_memory_that_stores_is_well_and_unchanged(client, place):
    with open_memory(place) as memory:
        before = memory.show() | {"revision": memory.revision()}
        assert [client.get("/healthz").json()["status"] for _ in range(3)] == ["ok"] * 3
        assert memory.show() | {"revision": memory.revision()} == before


def test_a_full_disk_is_seen_and_its_end_too(serve, new_place, monkeypatch):
    """A file that may not grow stands for the full disk: SQLite refuses with the same error."""
    where = new_place("sqlite")
    client = serve(where)
    trial = health_routes.store_nothing

    def refused(memory):
        with memory._store.pool.connection() as conn:
            pages = conn.value("PRAGMA page_count")
            conn.control(f"PRAGMA max_page_count = {pages}")
        with memory._store.writing() as conn:
            conn.execute("CREATE TABLE filler (content)")
            for _ in range(pages * 4):
                conn.execute("INSERT INTO filler VALUES (zeroblob(4096))")

    monkeypatch.setattr(health_routes, "store_nothing", refused)
    answer = client.get("/healthz")
    assert answer.status_code == 503
    assert answer.json()["error"]["message"] == "the memory does not store; the log of the service has the reason"
    monkeypatch.setattr(health_routes, "store_nothing", trial)
    client.get("/healthz")
    assert client.get("/healthz").status_code == 200


def test_the_reason_is_in_the_log_alone(serve, monkeypatch, caplog):
    def refused(memory):
        raise StoreError('connection to server at "10.1.2.3", port 5432 failed')

    client = serve()
    monkeypatch.setattr(health_routes, "store_nothing", refused)
    with caplog.at_level(logging.ERROR, "lifelore.service"):
        answers = [client.get("/healthz") for _ in range(3)]
    assert [answer.status_code for answer in answers] == [503] * 3
    assert "10.1.2.3" not in answers[-1].text
    assert [record.fields for record in caplog.records if record.message == "health"] == [
        {"error": 'connection to server at "10.1.2.3", port 5432 failed'}
    ]


def test_a_memory_that_cannot_be_written_is_not_well(serve, new_place):
    where = new_place("sqlite")
    client = serve(where)
    assert client.get("/healthz").status_code == 200
    with sqlite3.connect(where) as conn:
        conn.execute("DROP TABLE lifelore_leases")
    conn.close()
    assert client.get("/healthz").status_code == 503


def test_a_busy_memory_does_not_keep_health_waiting(serve, new_place, monkeypatch):
    monkeypatch.setattr(health_routes, "PATIENCE", 0.1)
    where = new_place("sqlite")
    client = serve(where)
    with open_memory(where) as memory, memory.together():
        answer = client.get("/healthz")
    assert answer.status_code == 200
