"""Parses the location of a memory: a file, or the URL of a PostgreSQL database."""

from pathlib import Path

import platformdirs
from sqlalchemy.engine import URL, make_url
from sqlalchemy.exc import ArgumentError

from lifelore.core.errors import InputError

DRIVER = "postgresql+psycopg"
_SCHEMES = ("postgresql", "postgres", DRIVER)
_SECRETS = ("password", "sslpassword", "passfile")


def default_path() -> Path:
    """`lifelore.db` in the user's data directory."""
    return Path(platformdirs.user_data_dir("lifelore", appauthor=False)) / "lifelore.db"


def locate(where: str | Path | None) -> Path | URL:
    """An absolute path, or a PostgreSQL URL with its driver named.

    Raises
    ------
    InputError
        `where` is empty, or a URL of another kind.
    """
    if where is None:
        return default_path()
    if not str(where).strip() or "\0" in str(where):
        raise InputError(
            f"memory must name a file or a postgresql:// URL, got {where!r}; leave it out for the default"
        )
    if isinstance(where, str) and "://" in where:
        return _postgresql_url(where)
    return Path(where).expanduser().absolute()


def describe(place: Path | URL) -> str:
    """`place` as text without passwords."""
    if isinstance(place, Path):
        return str(place)
    hidden = {name: "***" for name in _SECRETS if name in place.query}
    return place.update_query_dict(hidden).render_as_string(hide_password=True).replace("+psycopg", "", 1)


def _postgresql_url(where: str) -> URL:
    scheme = where.split("://", 1)[0]
    if scheme not in _SCHEMES:
        raise InputError(
            f"memory takes a file or a postgresql:// URL, got {scheme}://; for SQLite give the file itself"
        )
    try:
        return make_url(where).set(drivername=DRIVER)
    except (ArgumentError, ValueError) as error:
        # The text may contain a password, so the message does not repeat it.
        raise InputError(
            "memory: this postgresql:// URL cannot be read; write postgresql://user:password@host:5432/database"
        ) from error
