"""Notices that the files of a map changed, and reads them again when they are whole."""

import hashlib
from pathlib import Path

import yaml

from lifelore.core.errors import InputError
from lifelore.domains.buildings.occupancy_map import OccupancyMap
from lifelore.domains.worlds import WorldSettings, map_from_settings


class MapWatch:
    """Looks at a map's YAML and image when asked; a map that cannot be read changes nothing.

    The content counts, not the time of writing: saving the same map again is no change.

    Parameters
    ----------
    settings : WorldSettings
        Of a building with a map.
    """

    def __init__(self, settings: WorldSettings) -> None:
        self._settings = settings
        self._used = self._seen = self._digest()

    def changed(self) -> OccupancyMap | None:
        """The map if it is another one than the last that was read; None if it is the same.

        Raises
        ------
        InputError
            The files changed but are no whole map, perhaps half-written. The next look after a further change
            tries again.
        """
        content = self._digest()
        if content in (self._used, self._seen):
            self._seen = content
            return None
        self._seen = content
        occupancy = map_from_settings(self._settings)
        if self._digest() != content:
            self._seen = ""
            raise InputError(f"map: {self._settings.map} was being written while it was read; wait for the writer")
        self._used = content
        return occupancy

    def _digest(self) -> str:
        """Hash of the YAML file, and of its image as far as the YAML can be read."""
        path, digest = Path(str(self._settings.map)), hashlib.sha256()
        try:
            digest.update(path.read_bytes())
            image = path.parent / str(yaml.safe_load(path.read_bytes())["image"])
            digest.update(hashlib.sha256(image.read_bytes()).digest())
        except (OSError, yaml.YAMLError, ValueError, TypeError, KeyError, RecursionError):
            digest.update(b"not whole")
        return digest.hexdigest()
