"""Logs a perceived scene or a life in a building to a file whose ending names the kind: ``.mcap`` or ``.rrd``."""

from collections.abc import Mapping, Sequence
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lifelore.bridges.life_mcap import write_life_mcap
from lifelore.bridges.life_rerun import write_life_rrd
from lifelore.bridges.mcap_file import check_ros_extra
from lifelore.bridges.scene_mcap import write_scene_mcap
from lifelore.bridges.scene_rerun import rerun, write_scene_rrd
from lifelore.core.errors import InputError

if TYPE_CHECKING:
    from lifelore.domains.buildings.occupancy_map import OccupancyMap
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


def write_life_log(
    path: str,
    occupancy: "OccupancyMap",
    costs: NDArray[np.uint8],
    ways: Sequence[tuple[str, float, NDArray[np.float64]]],
    events: Sequence[tuple[str, float, tuple[float, float]]],
) -> None:
    """Write the map, costs, ways and events of a life; a file of this name is replaced. Errors as above.

    Parameters
    ----------
    path : str
    occupancy : OccupancyMap
    costs : (rows, columns) uint8
        On the pixels of the map, 0 to 100; larger values are unknown.
    ways : list of (name, seconds, points)
        When each way began, and its corners (n, 2) in metres of the map's frame.
    events : list of (name, seconds, point)
        What happened (``refused``, ``reached``, …), when and where.
    """
    seconds = itemgetter(1)
    _of_kind(path)[2](path, occupancy, costs, sorted(ways, key=seconds), sorted(events, key=seconds))


def _of_kind(path: str) -> tuple[Any, Any, Any]:
    ending = Path(path).suffix.lower()
    if ending not in _KINDS:
        raise InputError(f"log must name a file that ends with {' or '.join(_KINDS)}, got '{path}'")
    return _KINDS[ending]
