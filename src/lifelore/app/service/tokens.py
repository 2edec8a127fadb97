"""Tokens of the service's clients: a file of names, scopes, studies and SHA-256 hashes.

    NAME SCOPES HASH              a line for each token; SCOPES are some of read, write, admin, joined by commas
    NAME SCOPES@STUDIES HASH      a token for some studies alone, percent-encoded and joined by commas

``admin`` includes ``read`` and ``write``, and opens the memory as a whole. A token is 32 random bytes, so that its
hash needs no salt and no slow function: nobody can try all tokens. The token itself is printed once and stored
nowhere.
"""

import hashlib
import logging
import os
import re
import secrets
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote, unquote

from lifelore.core.errors import InputError, LifeloreError, NotFoundError, StoreError

SCOPES = ("read", "write", "admin")
FRESH = 1.0
"""Seconds until the file is looked at again; more lets a deleted token in for longer."""
_LINE = re.compile(r"([A-Za-z0-9_.-]{1,60})\s+([a-z,]+)(?:@([A-Za-z0-9_.~%,-]+))?\s+([0-9a-f]{64})")
_log = logging.getLogger("lifelore.service")


class Token(NamedTuple):
    """A token by its hash; without `studies` it is for all of them."""

    name: str
    scopes: frozenset[str]
    hashed: bytes
    studies: frozenset[str] | None = None


class TokenFile:
    """The tokens that the service accepts, read again within `FRESH` seconds of a change of their file.

    A line that was broken by the change is no token, and a deleted file holds none; both are logged.

    Raises
    ------
    NotFoundError
        There is no such file.
    InputError
        A line is none of a token, two have one name, or there is none.
    """

    def __init__(self, path: str, clock: Callable[[], float] = time.monotonic) -> None:
        self._path, self._clock = path, clock
        self._seen, self._looked = _state(path), clock()
        tokens = _read(path)
        if not tokens:
            raise InputError(
                f"token file '{path}' must hold a token; add one with: lifelore serve --add-token NAME"
            )
        self._tokens = {token.hashed: token for token in tokens}

    def find(self, token: str) -> Token | None:
        """The entry of a token; the look-up compares hashes, so its time says nothing about the tokens."""
        if (now := self._clock()) - self._looked > FRESH:
            self._looked = now
            if (state := _state(self._path)) != self._seen:
                self._seen = state
                self._read_again()
        return self._tokens.get(_hash(token))

    def _read_again(self) -> None:
        refused: list[LifeloreError] = []
        try:
            self._tokens = {token.hashed: token for token in _read(self._path, refused.append)}
        except LifeloreError as error:
            self._tokens = {}
            refused.append(error)
        for error in refused:
            _log.error("tokens", extra={"fields": {"error": str(error)}})


def add_token(path: str, name: str, scopes: Sequence[str], studies: Sequence[str] = ()) -> str:
    """Add a new token to a file and return it; a new file is readable by its owner only.

    Raises
    ------
    InputError
        The name or a scope breaks its rule, or the file has a token of that name.
    StoreError
        The file cannot be written.
    """
    token = secrets.token_urlsafe(32)
    rights = ",".join(scopes)
    if studies:
        rights += "@" + ",".join(quote(study, safe="") for study in studies)
    line = f"{name} {rights} {_hash(token).hex()}"
    entry = _parsed(line, "token")
    if Path(path).exists() and any(other.name == entry.name for other in _read(path)):
        raise InputError(f"token '{name}' is in '{path}' already; choose another name, or delete its line")
    try:
        with os.fdopen(
            os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o600), "a", encoding="ascii"
        ) as file:
            file.write(line + "\n")
    except OSError as error:
        raise StoreError(f"token file '{path}' cannot be written: {error.strerror}") from None
    return token


def _state(path: str) -> tuple[int, ...]:
    """What differs after a change of a file; empty where there is none."""
    try:
        found = os.stat(path)
    except OSError:
        return ()
    return found.st_mtime_ns, found.st_size, found.st_ino


def _raise(error: LifeloreError) -> None:
    raise error


def _read(path: str, refused: Callable[[LifeloreError], None] = _raise) -> list[Token]:
    """The tokens of a file; `refused` is called for each line that is none."""
    try:
        text = Path(path).read_text(encoding="ascii")
    except FileNotFoundError:
        raise NotFoundError(
            f"token file '{path}' does not exist; make it with: lifelore serve --add-token NAME"
        ) from None
    except (OSError, UnicodeDecodeError):
        raise InputError(f"token file '{path}' must be a text file that can be read") from None
    tokens: dict[str, Token] = {}
    for number, line in enumerate(map(str.strip, text.splitlines()), 1):
        if not line or line.startswith("#"):
            continue
        try:
            token = _parsed(line, f"token file '{path}' line {number}")
            if token.name in tokens:
                raise InputError(f"token file '{path}' must have each name once, got '{token.name}' twice")
        except InputError as error:
            refused(error)
        else:
            tokens[token.name] = token
    return list(tokens.values())


def _parsed(line: str, where: str) -> Token:
    found = _LINE.fullmatch(line)
    scopes = frozenset(found[2].split(",")) if found else frozenset()
    if found is None or not scopes <= set(SCOPES):
        # The line may hold a token by mistake, so the message does not repeat it.
        raise InputError(
            f"{where} must be a name of letters, digits, '_', '.' and '-', scopes (some of read, write and admin, "
            "joined by commas), and a hash"
        )
    if "admin" in scopes:
        scopes |= {"read", "write"}
    studies = frozenset(unquote(study) for study in found[3].split(",")) if found[3] else None
    return Token(found[1], scopes, bytes.fromhex(found[4]), studies)


def _hash(token: str) -> bytes:
    return hashlib.sha256(token.encode("utf-8", "replace")).digest()
