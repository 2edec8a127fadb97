"""Parses the location of a memory: a file, or the URL of a PostgreSQL database."""

from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import quote

from lifelore.core.errors import InputError, MissingExtraError

_SCHEMES = ("postgresql", "postgres", "postgresql+psycopg")
_SECRETS = ("password", "sslpassword", "passfile")


@dataclass(frozen=True)
class Server:
    """A PostgreSQL database.

    Parameters
    ----------
    location : str
        The URL without passwords.
    options : dict of str to str
        The arguments of libpq: ``host``, ``user``, ``dbname``, …
    """

    location: str
    options: dict[str, str] = field(repr=False)


def default_path() -> Path:
    """`lifelore.db` in the user's data directory."""
    import platformdirs

    return Path(platformdirs.user_data_dir("lifelore", appauthor=False)) / "lifelore.db"


def locate(where: str | Path | None) -> Path | Server:
    """An absolute path, or the parts of a PostgreSQL URL.

    Raises
    ------
    InputError
        `where` is empty, SQLite's name of a database without a file, or a URL of another kind.
    """
    if where is None:
        return default_path()
    if not str(where).strip() or "\0" in str(where):
        raise InputError(
            f"memory must name a file or a postgresql:// URL, got {where!r}; leave it out for the default"
        )
    if str(where) == ":memory:":
        raise InputError(
            "memory must be stored, got ':memory:'; name a file, in a temporary folder for a short life"
        )
    if isinstance(where, str) and "://" in where:
        return _postgresql_url(where)
    return Path(where).expanduser().absolute()


def describe(place: Path | Server) -> str:
    """`place` as text without passwords."""
    return str(place) if isinstance(place, Path) else place.location


def _postgresql_url(where: str) -> Server:
    scheme, rest = where.split("://", 1)
    if scheme not in _SCHEMES:
        raise InputError(
            f"memory takes a file or a postgresql:// URL, got {scheme}://; for SQLite give the file itself"
        )
    try:
        from psycopg import ProgrammingError
        from psycopg.conninfo import conninfo_to_dict
    except ImportError as error:
        raise MissingExtraError(
            "a postgresql:// memory needs psycopg, which is not installed; pip install 'lifelore[postgres]'"
        ) from error
    try:
        options = {name: str(value) for name, value in conninfo_to_dict(f"postgresql://{rest}").items()}
    except ProgrammingError:
        # The text may contain a password, so neither the message nor its cause repeats it.
        raise InputError(
            "memory: this postgresql:// URL cannot be read; write postgresql://user:password@host:5432/database, "
            "with %23 for #, %2F for / and %3F for ? in a password"
        ) from None
    return Server(_without_secrets(options), options)


def _without_secrets(options: dict[str, str]) -> str:
    """The URL of a database, with *** in place of passwords."""
    shown = {name: "***" if name in _SECRETS else quote(text, safe="/:") for name, text in options.items()}
    user = "".join([shown.pop("user", ""), ":***" if shown.pop("password", None) else ""])
    # A folder of sockets cannot stand in the place of a host.
    host = "" if "/" in shown.get("host", "") else shown.pop("host", "")
    place = f"{f'{user}@' if user else ''}{f'[{host}]' if ':' in host else host}"
    if "port" in shown:
        place += f":{shown.pop('port')}"
    rest = f"/{shown.pop('dbname')}" if "dbname" in shown else ""
    query = "&".join(f"{name}={text}" for name, text in shown.items())
    return f"postgresql://{place}{rest}{'?' if query else ''}{query}"
