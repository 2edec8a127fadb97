"""Logs a life in a building as an ``.rrd`` file for the viewer of Rerun; needs the extra ``view``.

All is in metres of the map's frame: ``map`` holds the occupied pixels, ``costs`` the expensive ones, and over the
timeline ``clock`` come ``way`` and ``events``.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.bridges.scene_rerun import recording
from lifelore.domains.buildings.logged_life import LoggedLife
from lifelore.domains.buildings.occupancy_map import OCCUPIED

MOST = 100
"""Largest cost; larger values of a mask are unknown."""


def write_life_rrd(path: str | Path, life: LoggedLife) -> None:
    """Write a life, see `write_life_log`.

    Raises
    ------
    MissingExtraError
        rerun is not installed.
    OSError
        The file cannot be written.
    """
    occupancy, costs = life.occupancy, life.costs
    dear = (costs > 0) & (costs <= MOST)
    heat = np.column_stack([np.full(dear.sum(), 255), 255 - 2 * costs[dear], np.zeros(dear.sum())]).astype(
        np.uint8
    )
    half = occupancy.resolution / 2
    with recording(path) as (rr, log):
        log.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        walls, places = (
            _flat(occupancy.metres(np.argwhere(chosen))) for chosen in (occupancy.state == OCCUPIED, dear)
        )
        log.log("map", rr.Points3D(walls, radii=half), static=True)
        log.log("costs", rr.Points3D(places, colors=heat, radii=half), static=True)
        for name, seconds, points in life.ways:
            log.set_time("clock", timestamp=seconds)
            log.log("way", rr.LineStrips3D([_flat(points)], labels=[name]))
        for name, seconds, point in life.events:
            log.set_time("clock", timestamp=seconds)
            log.log("events", rr.Points3D(_flat(np.array([point])), labels=[name], radii=4 * half))


def _flat(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points (n, 3) on the floor."""
    return np.column_stack([points, np.zeros(len(points))])
