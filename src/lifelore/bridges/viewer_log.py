"""Logs a perceived scene or a life in a building to a file whose ending names the kind: ``.mcap`` or ``.rrd``."""

from collections.abc import Mapping
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lifelore.bridges.life_mcap import write_life_mcap
from lifelore.bridges.life_rerun import write_life_rrd
from lifelore.bridges.mcap_file import check_ros_extra
from lifelore.bridges.scene_mcap import write_scene_mcap
from lifelore.bridges.scene_rerun import rerun, write_scene_rrd
from lifelore.core.errors import InputError
from lifelore.domains.buildings.logged_life import LoggedLife

if TYPE_CHECKING:
    from lifelore.perception.scene import Scene

_KINDS = {
    ".mcap": (check_ros_extra, write_scene_mcap, write_life_mcap),
    ".rrd": (rerun, write_scene_rrd, write_life_rrd),
}
"""For each ending what checks the extra, and what writes a scene and a life."""


def check_log(path: str) -> None:
    """Raise InputError for an unknown ending, and MissingExtraError where what the kind needs is not installed."""
    _of_kind(path)[0]()


def write_scene_log(path: str, scene: "Scene", document: Mapping[str, Any]) -> None:
    """Write a scene and its document, see `scene_mcap` and `scene_rerun`; a file of this name is replaced.

    Raises
    ------
    InputError
        The ending is unknown.
    MissingExtraError
        What the kind needs is not installed.
    OSError
        The file cannot be written.
    """
    _of_kind(path)[1](path, scene, document)


def write_life_log(path: str, life: LoggedLife) -> None:
    """Write a life, its ways and events in order of time; a file of this name is replaced. Errors as above."""
    ways, events = (sorted(one, key=itemgetter(1)) for one in (life.ways, life.events))
    _of_kind(path)[2](path, life._replace(ways=ways, events=events))


def _of_kind(path: str) -> tuple[Any, Any, Any]:
    ending = Path(path).suffix.lower()
    if ending not in _KINDS:
        raise InputError(f"log must name a file that ends with {' or '.join(_KINDS)}, got '{path}'")
    return _KINDS[ending]
