"""Atomic file writes: a reader sees the old content or the new content, never a part."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from lifelore.core.errors import InputError, StoreError


@contextmanager
def atomic_write(path: str | Path) -> Iterator[BinaryIO]:
    """Open a file that replaces `path` when the block ends without an error; otherwise `path` stays as it was.

    A link is followed. The folder must exist.

    Raises
    ------
    OSError
        The disk refuses.
    """
    place = Path(os.path.realpath(path))
    partial = place.with_name(f"{place.name}.{os.getpid()}.part")
    try:
        with partial.open("wb") as file:
            yield file
        os.replace(partial, place)
    except BaseException:
        with suppress(OSError):
            partial.unlink(missing_ok=True)
        raise


def write_file(path: str | Path, content: bytes, what: str) -> None:
    """Write a file at once; StoreError, which names `what` is in it, where the disk refuses."""
    try:
        with atomic_write(path) as file:
            file.write(content)
    except OSError as error:
        raise StoreError(f"{what} cannot be written to {path}: {error.strerror}") from None


def read_file(path: str | Path, what: str) -> bytes:
    """The bytes of a file; InputError, which names `what` is in it, where it cannot be read."""
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise InputError(f"{what} {path} cannot be read: {error.strerror}") from None
