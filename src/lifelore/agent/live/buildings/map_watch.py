"""Notices that the files of a map changed, and reads them again when they are whole."""

import hashlib
from pathlib import Path

import yaml

from lifelore.core.errors import InputError
from lifelore.domains.buildings.occupancy_map import OccupancyMap
from lifelore.domains.worlds import WorldSettings, map_from_settings


class MapWatch:
    """Looks at a map's YAML and image when asked; a map that cannot be read changes nothing.

    The content counts, not the time of writing: saving the same map again is no change. The times only save
    reading the files at every look.

    Parameters
    ----------
    settings : WorldSettings
        Of a building with a map.
    """

    def __init__(self, settings: WorldSettings) -> None:
        self._settings = settings
        self._files = self._times()
        self._content = self._digest()

    def changed(self) -> OccupancyMap | None:
        """The map if it is another one than at the last look; None if it is the same.

        Raises
        ------
        InputError
            The files changed but are no whole map, perhaps half-written. The next look after a further change
            tries again.
        """
        files = self._times()
        if files == self._files:
            return None
        self._files = files
        content = self._digest()
        if content == self._content:
            return None
        occupancy = map_from_settings(self._settings)
        if self._digest() != content:
            self._files = ()
            raise InputError(f"map: {self._settings.map} was being written while it was read; wait for the writer")
        self._content = content
        return occupancy

    def _paths(self) -> list[Path]:
        """The YAML file, and its image as far as the YAML can be read."""
        path = Path(str(self._settings.map))
        try:
            mapping = yaml.safe_load(path.read_bytes())
            return [path, path.parent / str(mapping["image"])]
        except (OSError, yaml.YAMLError, ValueError, TypeError, KeyError, RecursionError):
            return [path]

    def _times(self) -> tuple:
        """Time of writing and size of each file; None for a missing one."""
        return tuple(_time(path) for path in self._paths())

    def _digest(self) -> str:
        digest = hashlib.sha256()
        for path in self._paths():
            try:
                digest.update(hashlib.sha256(path.read_bytes()).digest())
            except OSError:
                digest.update(b"missing")
        return digest.hexdigest()


def _time(path: Path) -> tuple[int, int] | None:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size
