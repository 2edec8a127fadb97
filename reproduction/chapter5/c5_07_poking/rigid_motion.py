"""Rigid motions, and the registration of points to a surface.

Registration iterates over nearest points and minimises distances along the surface's normals (Chen and Medioni
1992), so that flat faces may slide.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

_ITERATIONS = 12
_DAMPING = 1e-3
"""Added to the normal equations, as a share of their trace; more slows motions that the surface leaves open."""


@dataclass(frozen=True, eq=False)
class RigidMotion:
    """``after = rotation @ before + shift``; rotation ``(3, 3)`` orthonormal, shift ``(3,)`` metres."""

    rotation: NDArray[np.float64]
    shift: NDArray[np.float64]

    def apply(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """The points ``(n, 3)`` after the motion."""
        return points @ self.rotation.T + self.shift

    def after(self, first: "RigidMotion") -> "RigidMotion":
        """The motion `first`, and then this motion."""
        return RigidMotion(self.rotation @ first.rotation, self.rotation @ first.shift + self.shift)

    def largest_step(self, points: NDArray[np.float64]) -> float:
        """Largest way of one of the points, metres."""
        return float(np.linalg.norm(self.apply(points) - points, axis=1).max(initial=0.0))


STILL = RigidMotion(np.eye(3), np.zeros(3))


def turned_about(
    middle: NDArray[np.float64], turn: NDArray[np.float64], shift: NDArray[np.float64]
) -> RigidMotion:
    """A turn by the rotation vector `turn` about a point, and then a shift."""
    rotation = Rotation.from_rotvec(turn).as_matrix()
    return RigidMotion(rotation, middle - rotation @ middle + shift)


def registered(
    points: NDArray[np.float64],
    surface: NDArray[np.float64],
    normals: NDArray[np.float64],
    tree: KDTree,
    start: RigidMotion,
    reach: float,
) -> RigidMotion:
    """The motion near `start` that lays points on a surface.

    Parameters
    ----------
    points : (n, 3) float64
    surface, normals : (m, 3) float64
        Points of the surface and its unit normals; `tree` is over the surface.
    start : RigidMotion
    reach : float
        Metres; points farther than this from the surface do not count. It halves over the iterations.
    """
    motion = start
    for limit in np.linspace(reach, reach / 2, _ITERATIONS):
        moved = motion.apply(points)
        distance, nearest = tree.query(moved, distance_upper_bound=limit)
        near, nearest = np.isfinite(distance), np.asarray(nearest)
        if np.count_nonzero(near) < 6:
            return motion
        moved, normal = moved[near], normals[nearest[near]]
        middle = moved.mean(axis=0)
        rows = np.column_stack([np.cross(moved - middle, normal), normal])
        gaps = np.einsum("ij,ij->i", surface[nearest[near]] - moved, normal)
        weights = 1.0 / np.maximum(np.abs(gaps), 0.002)
        matrix = rows.T @ (rows * weights[:, None])
        scale = np.diag([0.05, 0.05, 0.05, 1.0, 1.0, 1.0]) ** 2
        matrix += _DAMPING * np.trace(matrix) * scale
        step = np.linalg.solve(matrix, rows.T @ (weights * gaps))
        motion = turned_about(middle, step[:3], step[3:]).after(motion)
        if np.abs(step).max() < 1e-4:
            break
    return motion
