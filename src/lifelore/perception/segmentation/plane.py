"""The table's plane in a cloud: RANSAC finds it, least squares refines it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError

NEAR = 0.01
"""Metres from a plane within which a point supports it: about three sigma of a depth camera at 1.2 m."""
_HYPOTHESES = 400
_SAMPLE = 4000
_BATCH = 50
_LEAST_SHARE = 0.05
"""Least share of the points on a plane; unordered points have at most a few hundredths in any such slab."""


@dataclass(frozen=True, eq=False)
class Plane:
    """The points p with ``normal · p + offset = 0``.

    Parameters
    ----------
    normal : (3,) float64
        Unit vector.
    offset : float
        Metres; the height of the frame's origin above the plane.
    """

    normal: NDArray[np.float64]
    offset: float

    def height(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """(n,) metres above the plane, on the side of the normal."""
        return points @ self.normal + self.offset

    def flipped(self) -> "Plane":
        """The same plane seen from below."""
        return Plane(-self.normal, -self.offset)


def dominant_plane(points: NDArray[np.float64], rng: np.random.Generator) -> Plane:
    """The plane that most points lie on.

    Parameters
    ----------
    points : (n, 3) metres, finite
    rng : Generator
        Draws the hypotheses.

    Raises
    ------
    InputError
        No three points span a plane (fewer than three, or all on one line), or the best holds less than 5 % of
        the points.
    """
    sample = points if len(points) <= _SAMPLE else points[rng.choice(len(points), _SAMPLE, replace=False)]
    normals, offsets = _hypotheses(sample, rng)
    if len(normals) == 0:
        raise InputError("no plane can be found in the cloud; pass --up X,Y,Z (or z)")
    votes = np.concatenate(
        [
            (np.abs(sample @ normals[i : i + _BATCH].T + offsets[i : i + _BATCH]) <= NEAR).sum(axis=0)
            for i in range(0, len(normals), _BATCH)
        ]
    )
    best = int(votes.argmax())
    if votes[best] < _LEAST_SHARE * len(sample):
        raise InputError("no plane stands out in the cloud; pass --up X,Y,Z (or z)")
    return refined(points, Plane(normals[best], float(offsets[best])))


def refined(points: NDArray[np.float64], plane: Plane) -> Plane:
    """The least-squares plane of the points near `plane`, repeated up to five times with the new plane."""
    near_plane = None
    for _ in range(5):
        before, near_plane = near_plane, np.abs(plane.height(points)) <= NEAR
        if before is not None and np.array_equal(before, near_plane):
            return plane  # the same points give the same plane
        close = points[near_plane]
        if len(close) < 3:
            return plane
        centre = close.mean(axis=0)
        close -= centre
        # A copy: for an array and its own transpose NumPy uses another sum, with other last bits.
        spread = close.T @ close.copy()
        normal = np.linalg.eigh(spread)[1][:, 0]
        if normal @ plane.normal < 0:
            normal = -normal
        plane = Plane(normal, float(-normal @ centre))
    return plane


def _hypotheses(
    sample: NDArray[np.float64], rng: np.random.Generator
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    if len(sample) < 3:
        return np.empty((0, 3)), np.empty(0)
    a, b, c = sample[rng.integers(0, len(sample), (3, _HYPOTHESES))]
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    # Thin triangles give wild normals: the area must be more than a square of two millimetres.
    good = lengths > 8e-6
    normals, a = normals[good] / lengths[good, None], a[good]
    return normals, -np.einsum("ij,ij->i", normals, a)
