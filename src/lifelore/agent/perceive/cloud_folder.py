"""New clouds of a folder, each read when its file is whole; found by polling, which works on every file system."""

import os
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from threading import Event

from lifelore.core.errors import InputError, LifeloreError
from lifelore.perception.clouds.point_cloud import PointCloud

SUFFIXES = (".pcd", ".ply", ".npz", ".npy")
LOOK_EVERY = 0.1
"""Seconds between two looks at the folder."""
SETTLED = 0.3
"""Seconds without a change after which a file is read. Shorter answers sooner; longer waits for slower writers."""
PATIENCE = 5.0
"""Seconds without a change after which a file that cannot be read is given up: its writer may have paused."""

Version = tuple[int, int, int]
"""Inode, bytes and time of the last change (ns) of a file: another version differs in one of them."""


@dataclass
class _Waiting:
    """A version that was not perceived yet, since when it is unchanged, and when to try it."""

    version: Version
    since: float
    due: float


def new_clouds(
    folder: str | os.PathLike[str],
    read: Callable[[str], PointCloud],
    stop: Event,
    clock: Callable[[], float] = time.monotonic,
) -> Iterator[tuple[str, PointCloud | LifeloreError]]:
    """Each file that appears in a folder or changes there, with its cloud or why it is none.

    A file is read once it has not changed for `SETTLED` seconds, and its cloud counts only if the file is the same
    after it was read; a file that cannot be read is tried again after `PATIENCE`. So a half-written file is not
    taken for a cloud. No version is given twice. Files that are in the folder at the start are left alone until
    they change, and so are hidden files and those of other kinds than `SUFFIXES`.

    Parameters
    ----------
    folder : path
    read : callable
        Gives the cloud of a path, or raises a `LifeloreError`.
    stop : Event
        Ends the iterator.
    clock : callable
        Seconds that never run backwards.

    Raises
    ------
    InputError
        At once where the folder does not exist; later where it has gone.
    """
    return _arrivals(folder, read, stop, clock, _versions(folder))


def _arrivals(
    folder: str | os.PathLike[str],
    read: Callable[[str], PointCloud],
    stop: Event,
    clock: Callable[[], float],
    done: dict[str, Version],
) -> Iterator[tuple[str, PointCloud | LifeloreError]]:
    waiting: dict[str, _Waiting] = {}
    pause = LOOK_EVERY
    while not stop.wait(pause):
        began = time.perf_counter()
        there = _versions(folder)
        # A folder of ten thousand recordings must not keep a core busy.
        pause = max(LOOK_EVERY, 10 * (time.perf_counter() - began))
        done = {path: version for path, version in done.items() if path in there}
        waiting = {path: one for path, one in waiting.items() if path in there}
        for path, version in sorted(there.items()):
            if done.get(path) == version or stop.is_set():
                continue
            now = clock()
            one = waiting.get(path)
            if one is None or one.version != version:
                waiting[path] = _Waiting(version, now, now + SETTLED)
            elif now >= one.due:
                found = _attempt(read, path)
                if _version(path) != version:
                    continue  # it changed meanwhile: the next look sees another version
                if isinstance(found, LifeloreError) and one.due < one.since + PATIENCE:
                    one.due = one.since + PATIENCE
                    continue
                done[path] = version
                del waiting[path]
                yield path, found


def _attempt(read: Callable[[str], PointCloud], path: str) -> PointCloud | LifeloreError:
    try:
        return read(path)
    except LifeloreError as error:
        return error


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
