"""The plane of a table's points: least squares of those near the best of many triples, again and again."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream

NEAR = 0.01
"""Metres from a plane within which a point supports it: about three sigma of a depth camera at 1.2 m."""
_WIDER, _ROUNDS = 1.5, 25
_SAMPLE, _TRIPLES = 4000, 200
_LINE = 1e-9
"""Least share of the second largest of the largest spread; less is a line of points."""
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


def fitted_plane(points: NDArray[np.float64]) -> Plane:
    """The plane that most of a table's points (n, 3) lie on, in finite metres; its normal has either sign.

    Least squares of the points near the best plane through three of them, then again of those near the plane
    before: within `NEAR`, or within `_WIDER` times the median distance where that is more. Up to two fifths of the
    points may lie elsewhere: on a shelf, legs or a front.

    Raises
    ------
    InputError
        No three points span a plane (fewer than three, or all on one line), or it holds less than 5 % of them.
    """
    close, before, rounds = _supporting(points), None, 0
    while True:
        if len(close) < 3:
            raise InputError("no plane can be found in the cloud; pass --up X,Y,Z (or z)")
        centre = close.mean(axis=0)
        close = close - centre
        # A copy: for an array and its own transpose NumPy uses another sum, with other last bits.
        spread, axes = np.linalg.eigh(close.T @ close.copy())
        if not spread[1] > _LINE * max(float(spread[2]), 1e-12):
            raise InputError("no plane can be found in the cloud; pass --up X,Y,Z (or z)")
        plane = Plane(axes[:, 0], float(-axes[:, 0] @ centre))
        away = np.abs(plane.height(points))
        near = away <= max(NEAR, _WIDER * float(np.median(away)))
        rounds += 1
        if rounds == _ROUNDS or (before is not None and np.array_equal(near, before)):
            break  # the same points give the same plane
        close, before = points[near], near
    if np.mean(away <= NEAR) < _LEAST_SHARE:
        raise InputError("no plane stands out in the cloud; pass --up X,Y,Z (or z)")
    return plane


def _supporting(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """The points near the plane, of many through three of them, that most points are near; all where none is."""
    if len(points) < 3:
        return points
    rng = stream(0, "perception", "table plane")
    sample = points[:: max(1, len(points) // _SAMPLE)]
    a, b, c = sample[rng.integers(0, len(sample), (3, _TRIPLES))]
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    # Thin triangles give wild normals: the area must be more than a square of two millimetres.
    normals, a = normals[areas > 8e-6] / areas[areas > 8e-6, None], a[areas > 8e-6]
    if not len(a):
        return points
    offsets = -np.einsum("ij,ij->i", normals, a)
    best = int((np.abs(sample @ normals.T + offsets) <= NEAR).sum(axis=0).argmax())
    return points[np.abs(points @ normals[best] + offsets[best]) <= NEAR]
