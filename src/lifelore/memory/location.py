"""Parses the location of a memory: a file, or the URL of a PostgreSQL database."""

import re
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import parse_qsl, unquote

from lifelore.core.errors import InputError

_SCHEMES = ("postgresql", "postgres", "postgresql+psycopg")
_SECRETS = ("password", "sslpassword", "passfile")
_PARTS = re.compile(
    r"""(?:(?P<user>[^:/]*)(?::(?P<password>[^@]*))?@)?
    (?:\[(?P<address>[^\]/?]+)\]|(?P<host>[^/:?]*))(?::(?P<port>\d+))?
    (?:/(?P<dbname>[^?]*))?(?:\?(?P<query>.*))?""",
    re.VERBOSE,
)


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


def describe(place: Path | Server) -> str:
    """`place` as text without passwords."""
    return str(place) if isinstance(place, Path) else place.location


def _postgresql_url(where: str) -> Server:
    scheme, rest = where.split("://", 1)
    if scheme not in _SCHEMES:
        raise InputError(
            f"memory takes a file or a postgresql:// URL, got {scheme}://; for SQLite give the file itself"
        )
    found = _PARTS.fullmatch(rest)
    if found is None:
        # The text may contain a password, so the message does not repeat it.
        raise InputError(
            "memory: this postgresql:// URL cannot be read; write postgresql://user:password@host:5432/database"
        )
    parts = {name: unquote(text) for name, text in found.groupdict().items() if text}
    query = parse_qsl(found["query"] or "", keep_blank_values=True)
    options = {{"address": "host"}.get(name, name): text for name, text in parts.items() if name != "query"}
    return Server(f"postgresql://{_without_secrets(rest, found)}", options | dict(query))


def _without_secrets(rest: str, found: re.Match[str]) -> str:
    """The URL behind its scheme, with *** in place of passwords."""
    head = rest if found["query"] is None else rest[: found.start("query")]
    if found["password"] is not None:
        head = head[: found.start("password")] + "***" + head[found.end("password") :]
    pairs = (pair.partition("=") for pair in (found["query"] or "").split("&"))
    return head + "&".join(
        name + equals + ("***" if unquote(name) in _SECRETS else text) for name, equals, text in pairs
    )
