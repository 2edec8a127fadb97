"""Finds new clouds of a folder by polling, and reads each when its file is complete."""

import os
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from threading import Event

from lifelore.core.errors import InputError, LifeloreError
from lifelore.perception.clouds.point_cloud import PointCloud

SUFFIXES = (".pcd", ".ply", ".npz", ".npy")
LOOK_EVERY = 0.1
"""Seconds between two scans of the folder."""
SETTLED = 0.3
"""Seconds without a change after which a file is read; fewer give results sooner, more allow slower writers."""
RETRY_AFTER = 5.0
"""Seconds without a change after which a file that could not be read is tried a last time; its writer may
pause."""

Version = tuple[int, int, int]
"""Inode, size in bytes and time of the last change (ns) of a file; versions differ in one of them."""


@dataclass
class _Waiting:
    """A version not yet read, the time since when it is unchanged, and the time to read it."""

    version: Version
    since: float
    due: float


def new_clouds(
    folder: str | os.PathLike[str],
    read: Callable[[str], PointCloud],
    stop: Event,
    clock: Callable[[], float] = time.monotonic,
) -> Iterator[tuple[str, PointCloud | LifeloreError]]:
    """Each new or changed file of a folder, with its cloud or the error of reading it.

    A file is read when it has not changed for `SETTLED` seconds, and its cloud counts only if the file has not
    changed during reading. A file that cannot be read is tried again after `RETRY_AFTER`. So an incomplete file
    does not give a cloud. Each version is given once. Files that are in the folder at the start are ignored until
    they change. Hidden files and files without one of the `SUFFIXES` are always ignored.

    Parameters
    ----------
    folder : path
    read : callable
        Gives the cloud of a path, or raises a `LifeloreError`.
    stop : Event
        Ends the iterator.
    clock : callable
        Gives monotonic seconds.

    Raises
    ------
    InputError
        The folder does not exist: at once, or later if it disappears.
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
        present = _versions(folder)
        # Scans of a large folder take at most a tenth of the time.
        pause = max(LOOK_EVERY, 10 * (time.perf_counter() - began))
        done = {path: version for path, version in done.items() if path in present}
        waiting = {path: entry for path, entry in waiting.items() if path in present}
        for path, version in sorted(present.items()):
            if done.get(path) == version or stop.is_set():
                continue
            now = clock()
            entry = waiting.get(path)
            if entry is None or entry.version != version:
                waiting[path] = _Waiting(version, now, now + SETTLED)
            elif now >= entry.due:
                cloud = _attempt(read, path)
                if _version(path) != version:
                    continue  # it changed during reading: the next scan finds another version
                if isinstance(cloud, LifeloreError) and entry.due < entry.since + RETRY_AFTER:
                    entry.due = entry.since + RETRY_AFTER
                    continue
                done[path] = version
                del waiting[path]
                yield path, cloud


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
