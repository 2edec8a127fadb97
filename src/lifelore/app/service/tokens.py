"""Tokens of the service's clients: a file of names, scopes and SHA-256 hashes.

    NAME SCOPES HASH        a line for each token; SCOPES is read, write, or read,write

A token is 32 random bytes, so that its hash needs no salt and no slow function: nobody can try all tokens. The
token itself is printed once and stored nowhere.
"""

import hashlib
import hmac
import os
import re
import secrets
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from lifelore.core.errors import InputError, NotFoundError, StoreError

SCOPES = ("read", "write")
_LINE = re.compile(r"([A-Za-z0-9_.-]{1,60})\s+([a-z,]+)\s+([0-9a-f]{64})")


class Token(NamedTuple):
    """A token by its hash."""

    name: str
    scopes: frozenset[str]
    hashed: bytes


class TokenFile:
    """The tokens that the service accepts."""

    def __init__(self, tokens: Sequence[Token]) -> None:
        self._tokens = tuple(tokens)

    def find(self, token: str) -> Token | None:
        """The entry of a token; every entry is compared, so the time says nothing about the tokens."""
        hashed, found = _hash(token), None
        for entry in self._tokens:
            if hmac.compare_digest(entry.hashed, hashed):
                found = entry
        return found


def read_tokens(path: str) -> TokenFile:
    """The tokens of a file.

    Raises
    ------
    NotFoundError
        There is no such file.
    InputError
        A line is none of a token, two have one name, or there is none.
    """
    tokens = _read(path)
    if not tokens:
        raise InputError(f"token file '{path}' must hold a token; add one with: lifelore serve --add-token NAME")
    return TokenFile(tokens)


def add_token(path: str, name: str, scopes: Sequence[str]) -> str:
    """Add a new token to a file and return it; a new file is readable by its owner only.

    Raises
    ------
    InputError
        The name or a scope breaks its rule, or the file has a token of that name.
    StoreError
        The file cannot be written.
    """
    token = secrets.token_urlsafe(32)
    line = f"{name} {','.join(scopes)} {_hash(token).hex()}"
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


def _read(path: str) -> list[Token]:
    try:
        text = Path(path).read_text(encoding="ascii")
    except FileNotFoundError:
        raise NotFoundError(
            f"token file '{path}' does not exist; make it with: lifelore serve --add-token NAME"
        ) from None
    except (OSError, UnicodeDecodeError):
        raise InputError(f"token file '{path}' must be a text file that can be read") from None
    lines = [line.strip() for line in text.splitlines()]
    tokens = [
        _parsed(line, f"token file '{path}' line {number}")
        for number, line in enumerate(lines, 1)
        if line and not line.startswith("#")
    ]
    for name in (entry.name for entry in tokens):
        if sum(other.name == name for other in tokens) > 1:
            raise InputError(f"token file '{path}' must have each name once, got '{name}' twice")
    return tokens


def _parsed(line: str, where: str) -> Token:
    found = _LINE.fullmatch(line)
    scopes = frozenset(found[2].split(",")) if found else frozenset()
    if found is None or not scopes <= set(SCOPES):
        # The line may hold a token by mistake, so the message does not repeat it.
        raise InputError(
            f"{where} must be a name of letters, digits, '_', '.' and '-', scopes (read, write or read,write), "
            "and a hash"
        )
    return Token(found[1], scopes, bytes.fromhex(found[3]))


def _hash(token: str) -> bytes:
    return hashlib.sha256(token.encode("utf-8", "replace")).digest()
