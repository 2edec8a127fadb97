"""Finds new clouds of a folder by polling, each when its file is complete."""

import os
from collections.abc import Iterator
from threading import Event

from lifelore.core.errors import InputError

SUFFIXES = (".pcd", ".ply", ".npz", ".npy")
LOOK_EVERY = 0.3
"""Seconds between two looks at the folder; fewer give clouds sooner, more allow slower writers."""

Version = tuple[int, int, int]
"""Inode, size in bytes and time of the last change (ns) of a file; versions differ in one of them."""


def new_clouds(folder: str | os.PathLike[str], stop: Event) -> Iterator[str]:
    """The path of each new or changed file of a folder, once two looks have found it the same.

    Each version is given once; a file whose writer pauses for longer comes again when it goes on. Files that are
    in the folder at the start are ignored until they change. Hidden files and files without one of the `SUFFIXES`
    are always ignored.

    Parameters
    ----------
    folder : path
    stop : Event
        Ends the iterator.

    Raises
    ------
    InputError
        The folder does not exist: at once, or later if it disappears.
    """
    return _settled(folder, stop, _versions(folder))


def _settled(folder: str | os.PathLike[str], stop: Event, done: dict[str, Version]) -> Iterator[str]:
    before = dict(done)
    while not stop.wait(LOOK_EVERY):
        present = _versions(folder)
        for path, version in sorted(present.items()):
            # Whoever reads the clouds may take long over one, so the next is looked at once more.
            if done.get(path) != version == before.get(path) == _version(path) and not stop.is_set():
                done[path] = version
                yield path
        before = present


def _versions(folder: str | os.PathLike[str]) -> dict[str, Version]:
    try:
        with os.scandir(folder) as entries:
            clouds = [entry.path for entry in entries if _is_cloud_name(entry.name)]
    except OSError as error:
        raise InputError(f"watch must name a folder, got '{folder}': {error.strerror}") from None
    found = ((path, _version(path)) for path in clouds)
    return {path: version for path, version in found if version is not None}


def _is_cloud_name(name: str) -> bool:
    return name.lower().endswith(SUFFIXES) and not name.startswith(".")


def _version(path: str) -> Version | None:
    try:
        state = os.stat(path)
    except OSError:
        return None
    return state.st_ino, state.st_size, state.st_mtime_ns
