"""Room for two fingers beside an object, measured on the points that a camera sees.

The agent knows how its gripper grasps: the fingers go down at the object's narrowest side, `CLEARANCE` beyond its
outline, to 1 cm above its lowest point or 6 cm below its highest, whichever is higher. It does not know how thick
the fingers are today.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CLEARANCE = 0.004
"""Metres between the object's outline and each finger."""
LOWEST_TIP, DEEPEST_TIP = 0.01, 0.06
"""Metres of a finger's tip above the object's lowest point, and below its highest."""
DIRECTIONS = 36
"""Directions in which an object's width is measured."""
OUTLIERS = 0.005
"""Share of the points that are taken for noise at each end of an object."""


class Grasp(NamedTuple):
    """Where fingers go.

    along, across : (2,) unit vectors: the line through the fingers, and its normal
    ends : both ends of the object on the line, metres
    middle : the middle of the object on the normal, metres
    tip : height of the fingers' tips, metres
    """

    along: Array
    across: Array
    ends: tuple[float, float]
    middle: float
    tip: float


def grasp_of(points: NDArray[np.floating], lowest: float) -> Grasp:
    """The grasp of an object with points (n, 3), whose lowest point is at a height `lowest`."""
    angles = np.linspace(0, np.pi, DIRECTIONS, endpoint=False)
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    spans = points[:, :2] @ directions.T
    low, high = np.quantile(spans, [OUTLIERS, 1 - OUTLIERS], axis=0)
    best = int((high - low).argmin())
    along = directions[best]
    across = np.array([-along[1], along[0]])
    sides = np.quantile(points[:, :2] @ across, [OUTLIERS, 1 - OUTLIERS])
    tip = max(lowest + LOWEST_TIP, float(points[:, 2].max()) - DEEPEST_TIP)
    return Grasp(along, across, (float(low[best]), float(high[best])), float(sides.mean()), tip)


def reach_into(grasp: Grasp, neighbour: NDArray[np.floating], thicknesses: tuple[float, ...]) -> Array:
    """How far a neighbour's points (n, 3) reach into fingers of some thicknesses, metres; at most 0 where free.

    Of the two fingers the one with less room counts. Points below the tips are not in the way.
    """
    high = neighbour[neighbour[:, 2] > grasp.tip]
    found = np.full(len(thicknesses), -np.inf)
    if not len(high):
        return found
    along, across = high[:, :2] @ grasp.along, high[:, :2] @ grasp.across - grasp.middle
    for place, thickness in enumerate(thicknesses):
        beyond = CLEARANCE + thickness / 2
        for end in (grasp.ends[0] - beyond, grasp.ends[1] + beyond):
            found[place] = max(found[place], thickness / 2 - float(np.hypot(along - end, across).min()))
    return found
