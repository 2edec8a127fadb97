"""Refinement of a registration: points of one view are drawn onto the planes of the other's surface.

The point-to-plane form of the iterative closest point method. A point and its partner must face the same way: the
front of a thin object in one view is not drawn onto its back in the other, where generalised ICP (small_gicp)
slides by centimetres; elsewhere the two are equally precise.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from lifelore.perception.registration.tabletop_view import TabletopView

WIDEST, NARROWEST = 0.015, 0.006
"""Metres between partners in the first and in the last rounds: the error of a start, and of the sensor."""
_SHRINK = 0.85
_ROUNDS = 25
_ALIKE = 0.7
"""Least cosine between the normals of partners, 45°."""
_POINTS = 2000
"""Points of objects that are drawn, and half as many of the table; more are slower, and no more precise."""
_FEWEST = 50
_STILL = 2e-5
"""Radians and metres: a smaller step ends the refinement."""


def refined_motion(
    target: TabletopView, source: TabletopView, motion: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """The rigid motion (4, 4) of `source` onto `target` near `motion`; None where hardly a point has a partner."""
    n = len(source.objects)
    chosen = np.concatenate([_spread(n, _POINTS), n + _spread(len(source.table), _POINTS // 2)])
    points, normals = source.surface[chosen], source.surface_normals[chosen]
    radius = WIDEST
    for _ in range(_ROUNDS):
        step = _step(target, points @ motion[:3, :3].T + motion[:3, 3], normals @ motion[:3, :3].T, radius)
        if step is None:
            return None
        change = np.eye(4)
        change[:3, :3], change[:3, 3] = Rotation.from_rotvec(step[:3]).as_matrix(), step[3:]
        motion = change @ motion
        if radius == NARROWEST and np.abs(step).max() < _STILL:
            break
        radius = max(_SHRINK * radius, NARROWEST)
    return motion


def _spread(n: int, most: int) -> NDArray[np.int64]:
    """At most `most` of the numbers below n, evenly spread."""
    return np.unique(np.linspace(0, n - 1, min(n, most)).astype(np.int64))


def _step(
    target: TabletopView, points: NDArray[np.float64], normals: NDArray[np.float64], radius: float
) -> NDArray[np.float64] | None:
    """(6,): small rotation vector and shift that bring points nearest to their partners' planes."""
    distances, nearest = target.tree.query(points, distance_upper_bound=radius)
    partners = np.asarray(nearest, np.int64)
    found = np.flatnonzero(np.isfinite(distances))
    facing = np.einsum("ij,ij->i", normals[found], target.surface_normals[partners[found]]) > _ALIKE
    found = found[facing]
    if len(found) < _FEWEST:
        return None
    planes = target.surface_normals[partners[found]]
    gaps = np.einsum("ij,ij->i", target.surface[partners[found]] - points[found], planes)
    slopes = np.concatenate([np.cross(points[found], planes), planes], axis=1)
    # The small diagonal keeps still what no point determines: the turn of a single cylinder.
    return np.linalg.solve(slopes.T @ slopes + 1e-6 * np.eye(6), slopes.T @ gaps)
