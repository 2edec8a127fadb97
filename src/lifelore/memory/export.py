"""Exports a memory to a portable file, itself a memory; the file appears complete or not at all."""

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

    An existing file is replaced only if it is an earlier export, never if it is a memory in use.
    """
    aside = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    _refuse_to_overwrite(path)
    try:
        count = _write(store, aside)
        with one_line_refusals(str(path)):
            os.replace(aside, path)
    finally:
        for ending in ("", "-journal"):
            # If `path` is below a file, there is nothing to delete, and the error in progress reports it.
            with suppress(NotADirectoryError):
                aside.with_name(aside.name + ending).unlink(missing_ok=True)
    return count


def _write(store: Store, path: Path) -> int:
    copy = open_file(path, durable=True, journal="DELETE")
    try:
        with store.reading() as source, copy.writing() as target:
            union = MemoryUnion(target)
            added = union.take(source, store.location)["added"]
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
