"""Objects of JSON lines, one a line, from a file, standard input or a list."""

import json
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from lifelore.core.errors import InputError, NotFoundError, StoreError

Lines = Iterable[str | Mapping[str, Any]]
"""Lines of JSON, or the objects that they would hold."""


def lines_of(path: str) -> Iterator[str]:
    """The lines of a file in UTF-8; ``-`` is standard input.

    Raises
    ------
    NotFoundError
        There is no such file.
    StoreError
        The file cannot be read.
    """
    if path == "-":
        yield from sys.stdin
        return
    if not Path(path).is_file():
        raise NotFoundError(f"file '{path}' does not exist; give a file of JSON lines")
    try:
        with open(path, encoding="utf-8") as file:
            yield from file
    except OSError as error:
        raise StoreError(f"cannot read {path}: {error.strerror}") from None


def read_objects(lines: Lines, name: str) -> Iterator[tuple[int, dict[str, Any]]]:
    """The number of each line, from 1, and its object; empty lines are skipped.

    Raises
    ------
    InputError
        A line is no object; the message gives `name` and the number of the line.
    """
    for number, line in enumerate(_decoded(lines, name), 1):
        if isinstance(line, Mapping):
            yield number, dict(line)
            continue
        if not line.strip():
            continue
        try:
            document = json.loads(line)
        except (ValueError, RecursionError):
            raise InputError(
                f"{name} line {number}: not JSON, got {line.strip()[:60]!r}; one object a line"
            ) from None
        if not isinstance(document, dict):
            raise InputError(f"{name} line {number}: must be an object {{…}}, got {line.strip()[:60]!r}")
        yield number, document


def _decoded(lines: Lines, name: str) -> Iterator[str | Mapping[str, Any]]:
    # A file is decoded in blocks, so the line of a wrong byte is unknown.
    try:
        yield from lines
    except UnicodeDecodeError:
        raise InputError(f"{name} must be JSON lines in UTF-8, got other bytes; convert the file") from None
