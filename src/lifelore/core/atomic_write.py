"""Atomic file writes: a reader sees the old content or the new content, never a part."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO


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
