"""Atomic file writes: a reader sees the old content or the new content, never a part."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from lifelore.core.errors import InputError, StoreError


@contextmanager
def atomic_write(path: str | Path, what: str = "the file") -> Iterator[BinaryIO]:
    """Open a file that replaces `path` when the block ends without an error; otherwise `path` stays as it was.

    A link is followed. The folder must exist.

    Raises
    ------
    StoreError
        The disk refuses; see `refused_writes`.
    """
    place = Path(os.path.realpath(path))
    partial = place.with_name(f"{place.name}.{os.getpid()}.part")
    with refused_writes(path, what):
        try:
            with partial.open("wb") as file:
                yield file
            os.replace(partial, place)
        except BaseException:
            with suppress(OSError):
                partial.unlink(missing_ok=True)
            raise


@contextmanager
def refused_writes(path: str | Path, what: str = "the file") -> Iterator[None]:
    """Turn an error of the disk inside the block into a StoreError of one line, which names `what` is written."""
    try:
        yield
    except StoreError:
        raise
    except OSError as error:
        reason = error.strerror or error
        raise StoreError(f"{what} cannot be written to {path}: {reason}; choose another place") from None


def write_file(path: str | Path, content: bytes, what: str) -> None:
    """Write a file at once; StoreError, which names `what` is in it, where the disk refuses."""
    with atomic_write(path, what) as file:
        file.write(content)


def read_file(path: str | Path, what: str) -> bytes:
    """The bytes of a file; InputError, which names `what` is in it, where it cannot be read."""
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise InputError(f"{what} {path} cannot be read: {error.strerror}") from None
