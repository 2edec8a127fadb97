"""Logs a life in a building to a file whose ending names the kind: ``.mcap`` or ``.rrd``."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lifelore.bridges.life_mcap import write_life_mcap
from lifelore.bridges.life_rerun import write_life_rrd
from lifelore.bridges.scene_log import ending_of

if TYPE_CHECKING:
    from lifelore.domains.buildings.occupancy_map import OccupancyMap


def write_life_log(
    path: str,
    occupancy: "OccupancyMap",
    costs: NDArray[np.uint8],
    ways: Sequence[tuple[str, float, NDArray[np.float64]]],
    events: Sequence[tuple[str, float, tuple[float, float]]],
) -> None:
    """Write the map, costs, ways and events of a life; a file of this name is replaced.

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

    Raises
    ------
    InputError
        The ending is unknown.
    MissingExtraError
        What the kind needs is not installed.
    OSError
        The file cannot be written.
    """
    write = {".mcap": write_life_mcap, ".rrd": write_life_rrd}[ending_of(path)]
    write(path, occupancy, costs, sorted(ways, key=_seconds), sorted(events, key=_seconds))


def _seconds(entry: tuple) -> float:
    return entry[1]
