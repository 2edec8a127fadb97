"""A memory as one portable file: itself a valid memory, written aside and put in place whole."""

import os
from contextlib import suppress
from pathlib import Path

from lifelore.core.errors import InputError, StoreError
from lifelore.memory.merging import MemoryUnion
from lifelore.memory.refusal import one_line_refusals
from lifelore.memory.sqlite_file import is_in_use, read_header, refuse_unless_ours
from lifelore.memory.store import Store, open_file


def export(store: Store, path: Path) -> int:
    """Write all contributions and tombstones to `path`; the number of contributions.

    A file already there is replaced only if it is an earlier export, never a memory that was lived in.
    """
    aside = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    _refuse_to_overwrite(path)
    try:
        count = _write(store, aside)
        with one_line_refusals(str(path)):
            os.replace(aside, path)
    finally:
        for ending in ("", "-journal"):
            # Below a file there is nothing to tidy, and the refusal under way says so.
            with suppress(NotADirectoryError):
                aside.with_name(aside.name + ending).unlink(missing_ok=True)
    return count


def _write(store: Store, path: Path) -> int:
    copy = open_file(path, durable=True, journal="DELETE")
    try:
        with store.reading() as there, copy.writing() as here:
            union = MemoryUnion(here)
            added = union.take(there, store.location)["added"]
            union.finish()
            return added
    except StoreError as error:
        raise StoreError(f"the export was not written: {error}") from error
    finally:
        copy.close()


def _refuse_to_overwrite(path: Path) -> None:
    refuse_unless_ours(path)
    if path.exists() and path.stat().st_size and is_in_use(read_header(path)):
        raise InputError(f"path {path} is a memory in use, which an export must not replace; name another file")
