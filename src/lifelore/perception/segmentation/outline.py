"""The convex outline of points in a plane, and which points lie over it."""

import numpy as np
from numpy.typing import NDArray

_DIRECTIONS = np.stack([f(np.arange(16) * np.pi / 8) for f in (np.cos, np.sin)])
"""(2, 16) unit vectors; the farthest points in these directions span most of a hull."""


def over_outline(
    points: NDArray[np.float64], table: NDArray[np.float64], margin: float = 0.0
) -> NDArray[np.bool_]:
    """(n,) bool: whether points (n, 2) lie over the convex outline of table (m, 2); all do where there is none.

    The outline is grown by about `margin` metres on all sides: by an octagon, whose sides are that far away.
    """
    corners = convex_corners(table)
    if corners is None:
        return np.ones(len(points), bool)
    if margin > 0:
        octagon = margin / np.cos(np.pi / 8) * _DIRECTIONS.T[1::2]
        corners = convex_corners((corners[:, None] + octagon).reshape(-1, 2))
        assert corners is not None
    return _within(points, corners)


def convex_corners(points: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """(k, 2) corners of the convex hull of points (n, 2), counterclockwise; None where they span no area."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        if len(points) > 1000:
            # A point inside the hull of a few is no corner: Qhull has little left to do (Akl and Toussaint).
            extreme = np.unique((_DIRECTIONS.T @ points.T).argmax(axis=1))
            few = points[extreme][ConvexHull(points[extreme]).vertices]
            points = np.concatenate([few, points[~_within(points, few)]])
        return points[ConvexHull(points).vertices]
    except (QhullError, ValueError):
        return None


def _within(points: NDArray[np.float64], corners: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(n,) bool: whether points (n, 2) lie in a convex polygon with counterclockwise corners, or on its border."""
    x, y = points.T
    start = int(np.lexsort((corners[:, 1], corners[:, 0]))[0])
    around = np.roll(corners, -start, axis=0)
    turn = int(np.lexsort((around[:, 1], around[:, 0]))[-1])
    lower, upper = around[: turn + 1], np.concatenate([around[turn:], around[:1]])[::-1]
    # An upright side belongs to neither chain: each has one height for each x.
    lower = lower[: len(lower) - (lower[-2, 0] == lower[-1, 0])]
    upper = upper[int(upper[0, 0] == upper[1, 0]) :]
    inside = (x >= around[0, 0]) & (x <= around[turn, 0])
    return inside & (y >= np.interp(x, *lower.T)) & (y <= np.interp(x, *upper.T))
