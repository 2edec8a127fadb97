"""Logs a perceived scene to a file whose ending names the kind: ``.mcap`` or ``.rrd``."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lifelore.bridges.mcap_file import check_ros_extra
from lifelore.bridges.scene_mcap import write_scene_mcap
from lifelore.bridges.scene_rerun import rerun, write_scene_rrd
from lifelore.core.errors import InputError

if TYPE_CHECKING:
    from lifelore.perception.scene import Scene

CHECKS = {".mcap": check_ros_extra, ".rrd": rerun}
"""For each ending what checks the extra."""
_WRITERS = {".mcap": write_scene_mcap, ".rrd": write_scene_rrd}


def check_log(path: str) -> None:
    """Raise InputError for an unknown ending, and MissingExtraError where what the kind needs is not installed."""
    CHECKS[ending_of(path)]()


def write_scene_log(path: str, scene: "Scene", document: Mapping[str, Any]) -> None:
    """Write a scene and its document, see `scene_mcap` and `scene_rerun`.

    Raises
    ------
    InputError
        The ending is unknown.
    MissingExtraError
        What the kind needs is not installed.
    OSError
        The file cannot be written.
    """
    _WRITERS[ending_of(path)](path, scene, document)


def ending_of(path: str) -> str:
    """The ending of a log's name, one of `CHECKS`; else InputError."""
    ending = Path(path).suffix.lower()
    if ending not in CHECKS:
        raise InputError(f"log must name a file that ends with {' or '.join(CHECKS)}, got '{path}'")
    return ending
