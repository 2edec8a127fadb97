"""Finished cells on disk: a run that was stopped goes on where it was, one that rests on other code does not.

One file a cell, written beside its place and moved there in one step, so that a reader never sees half a cell.
"""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lifelore.core.atomic_write import atomic_write
from lifelore.core.errors import StoreError

VERSION = 1


def canonical(data: Any) -> str:
    """Plain data as the same text wherever it comes from."""
    return json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False)


class CellStore:
    """The finished cells of one run of one claim, or of all claims that share them.

    Parameters
    ----------
    folder : Path
        Made on the first `put`; hidden from version control by a file of its own.
    key : plain data
        Everything a result depends on beside the cell: claim, settings, seed, code.
    """

    def __init__(self, folder: Path, key: Mapping[str, Any]) -> None:
        self.folder = folder
        self._key = canonical({**key, "version": VERSION})

    def path(self, cell: Mapping[str, Any]) -> Path:
        """Where a cell is kept."""
        digest = hashlib.sha256((self._key + canonical(cell)).encode()).hexdigest()
        return self.folder / f"{digest[:24]}.json"

    def get(self, cell: Mapping[str, Any]) -> dict | None:
        """The stored ``{"cell", "result", "seconds"}``; None where there is none or it cannot be read."""
        try:
            kept = json.loads(self.path(cell).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None  # a cell is a cache of a pure run: whatever is wrong with it, running again mends it
        return kept if isinstance(kept, dict) and kept.get("cell") == json.loads(canonical(cell)) else None

    def put(self, cell: Mapping[str, Any], result: Mapping[str, Any], seconds: float) -> dict:
        """Keep a finished cell; returns it as `get` will."""
        kept = {"cell": cell, "result": result, "seconds": seconds}
        text = canonical(kept)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            (self.folder / ".gitignore").write_text("*\n", encoding="utf-8")
        except OSError as error:
            raise StoreError(f"cannot make {self.folder}: {error.strerror}; choose another place") from None
        write_atomically(self.path(cell), text)
        return json.loads(text)


def write_atomically(path: Path, text: str) -> None:
    """Write a text file in one step; StoreError where the disk refuses."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with atomic_write(path) as file:
            file.write(text.encode())
    except OSError as error:
        raise StoreError(f"cannot write {path}: {error.strerror}; choose another place") from None
