"""A disk that loses what was not synced when its power fails, under SQLite.

`Disk` is a VFS of SQLite: it keeps beside each file what a sync has made safe, and the changes since. At any
moment it writes what the files may be after a loss of power: each sector of each write since the last sync of
its file is there or not, whatever the order of the writes. A file that was deleted without a sync of its
folder is there or not.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import apsw
import numpy as np

SECTOR = 512
"""Bytes that a disk writes as a whole."""
Change = tuple[int, bytes | None]
"""A write of bytes at an offset, or (size, None) for a file that was cut."""


class Image:
    """What is safe of a file, and the changes since."""

    def __init__(self) -> None:
        self.safe = b""
        self.open: list[Change] = []
        self.deleted = False

    def sync(self) -> None:
        self.safe, self.open = _changed(self.safe, self.open), []

    def after_loss(self, rng: np.random.Generator) -> bytes | None:
        """The file after a loss of power; None where there is none."""
        if self.deleted and rng.random() < 0.5:
            return None
        kept = rng.random()
        parts = (part for change in self.open for part in _sectors(change))
        return _changed(self.safe, [part for part in parts if rng.random() < kept])


class Disk(apsw.VFS):
    """Files on a disk whose power may fail; `at_change` is called before each change of a file."""

    def __init__(self, name: str) -> None:
        self.vfs_name = name
        self.images: dict[str, Image] = {}
        self.at_change: Callable[[], None] = lambda: None
        super().__init__(name, "")

    def xOpen(self, name: Any, flags: list[int]) -> apsw.VFSFile:
        return _File(self, name, flags)

    def xDelete(self, filename: str, syncdir: bool) -> None:
        self.at_change()
        super().xDelete(filename, syncdir)
        if syncdir:
            self.images.pop(filename, None)
        elif filename in self.images:
            self.images[filename].deleted = True

    def lose_power(self, folder: Path, rng: np.random.Generator) -> None:
        """Write into `folder` what the files may be if the power fails now."""
        folder.mkdir()
        for path, image in self.images.items():
            content = image.after_loss(rng)
            if content is not None:
                (folder / Path(path).name).write_bytes(content)


class _File(apsw.VFSFile):
    def __init__(self, disk: Disk, name: Any, flags: list[int]) -> None:
        self._disk = disk
        path = name.filename() if isinstance(name, apsw.URIFilename) else name
        self._image = Image() if path is None else disk.images.setdefault(path, Image())
        if self._image.deleted:
            self._image.__init__()
        super().__init__("", name, flags)

    def xWrite(self, data: Any, offset: int) -> None:
        self._disk.at_change()
        self._image.open.append((offset, bytes(data)))
        super().xWrite(data, offset)

    def xTruncate(self, newsize: int) -> None:
        self._disk.at_change()
        self._image.open.append((newsize, None))
        super().xTruncate(newsize)

    def xSync(self, flags: int) -> None:
        self._image.sync()
        super().xSync(flags)


class Driver:
    """A connection of apsw on a disk with the methods of `sqlite3.Connection` that a memory calls."""

    def __init__(self, path: Path, disk: Disk) -> None:
        self._connection = apsw.Connection(str(path), vfs=disk.vfs_name)
        # A VFS in Python has no shared memory: the log needs a file that no other process opens.
        self._connection.execute("PRAGMA locking_mode = EXCLUSIVE")

    def execute(self, sql: str, parameters: Any = ()) -> Any:
        return self._connection.execute(sql, parameters)

    def executemany(self, sql: str, rows: Any) -> Any:
        return self._connection.executemany(sql, rows)

    def close(self) -> None:
        self._connection.close()


def _sectors(change: Change) -> list[Change]:
    offset, data = change
    if data is None:
        return [change]
    return [(offset + at, data[at : at + SECTOR]) for at in range(0, len(data), SECTOR)]


def _changed(content: bytes, changes: list[Change]) -> bytes:
    made = bytearray(content)
    for offset, data in changes:
        if data is None:
            del made[offset:]
        else:
            made.extend(bytes(max(0, offset - len(made))))
            made[offset : offset + len(data)] = data
    return bytes(made)
