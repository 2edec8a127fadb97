"""The outline of a robot, and paths on which it touches nothing: driven forwards, turned on the spot."""

import json
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage
from scipy.spatial import ConvexHull, KDTree, QhullError

from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.buildings.clear_path import clear_path
from lifelore.domains.buildings.floor import Floor

MARGIN = 0.5
"""Pixels that the outline keeps from the centres of solid pixels."""
BERTHS = 6
"""Number of clearances that are tried, from the inscribed to the circumscribed circle; more costs time, and finds
shorter paths."""


class Footprint:
    """The convex hull of an outline around the point about which the robot turns; x leads forwards, y to the left.

    Parameters
    ----------
    outline : (n, 2) float
        Corners in metres, n ≥ 3, around (0, 0).

    Raises
    ------
    InputError
        The outline breaks a rule.
    """

    def __init__(self, outline: ArrayLike) -> None:
        rule = "footprint must be three or more corners [x, y] in metres around [0, 0], such as [[0.3,0.2],…]"
        try:
            points = np.asarray(outline, float)
            hull = ConvexHull(points)
        except (ValueError, TypeError, IndexError, QhullError):
            raise InputError(f"{rule}; got {outline}") from None
        if points.shape[1] != 2 or hull.equations[:, 2].max() >= 0:
            raise InputError(f"{rule}; got {outline}")
        self.corners = points[hull.vertices]
        self._normals, self._offsets = hull.equations[:, :2], -hull.equations[:, 2]

    @classmethod
    def from_text(cls, text: str) -> "Footprint":
        """The outline as nav2's parameter ``footprint`` has it: ``[[0.3, 0.2], [0.3, -0.2], …]``.

        Raises
        ------
        InputError
            The text is no list of corners, or the outline breaks a rule.
        """
        try:
            return cls(json.loads(text))
        except (json.JSONDecodeError, RecursionError):
            return cls(text)

    @property
    def inscribed(self) -> float:
        """Radius of the largest circle about (0, 0) within the outline, in metres."""
        return float(self._offsets.min())

    @property
    def circumscribed(self) -> float:
        """Distance of the farthest corner from (0, 0) in metres."""
        return float(np.hypot(*self.corners.T).max())

    def first_contact(self, floor: Floor, path: NDArray[np.float64]) -> NDArray[np.float64] | None:
        """The first corner of a path, (2,) in metres, on or before whose line the outline touches an obstacle.

        The outline touches an obstacle if it comes within `MARGIN` of the centre of a solid pixel. The robot has
        the heading of each line while it drives it, and turns by the smaller angle from line to line.
        """
        if not floor.solid.any() or len(path) < 2:
            return None
        tree, points = _solid_tree(floor), _right_and_up(floor.pixels(path))
        headings = np.arctan2(*np.diff(points, axis=0).T[::-1])
        for k, (a, b) in enumerate(pairwise(points)):
            turn = 0.0 if k == 0 else (headings[k] - headings[k - 1] + np.pi) % (2 * np.pi) - np.pi
            # From one step of a turn to the next, no corner of the outline moves by more than the margin.
            steps = int(abs(turn) * self.circumscribed / floor.occupancy.resolution / MARGIN)
            turned = headings[k] - turn * np.arange(1, steps + 1) / (steps + 1)
            if any(self._touches(floor, tree, a, 0.0, heading, 1.5 * MARGIN) for heading in turned):
                return path[k]
            if self._touches(floor, tree, a, float(np.hypot(*(b - a))), headings[k], MARGIN):
                return path[k + 1]
        return None

    def _touches(
        self, floor: Floor, tree: KDTree, start: NDArray[np.float64], length: float, heading: float, margin: float
    ) -> bool:
        """Whether the outline, moved straight on by `length` pixels, comes within `margin` of a solid pixel."""
        scale = 1 / floor.occupancy.resolution
        forwards = np.array([np.cos(heading), np.sin(heading)])
        reach = self.circumscribed * scale + margin + 1
        near = tree.data[tree.query_ball_point(start + forwards * length / 2, reach + length / 2)] - start
        ahead, left = near @ forwards, near @ np.array([-forwards[1], forwards[0]])
        y = self.corners[:, 1] * scale
        inside = (left < y.max() + margin) & (left > y.min() - margin)
        for (normal_x, normal_y), offset in zip(self._normals, self._offsets * scale, strict=True):
            inside &= normal_x * ahead + normal_y * left < offset + max(0.0, normal_x * length) + margin
        return bool(inside.any())


def footprint_path(
    floor: Floor,
    start: tuple[float, float],
    goal: tuple[float, float],
    footprint: Footprint,
    price: NDArray[np.floating] | None = None,
) -> NDArray[np.float64] | None:
    """A path as `clear_path` finds it, on which the outline touches nothing.

    The path is first searched for the inscribed circle. Where the outline touches an obstacle, it is searched
    again with more clearance, up to the circumscribed circle. A free path that only a planner with headings finds,
    say backwards out of a niche, is not found.

    Raises
    ------
    NotFoundError
        The outline touches an obstacle at an end in any heading, or on every path that was tried.
    """
    resolution, contact = floor.occupancy.resolution, None
    for (x, y), pixel in zip((start, goal), floor.pixels([start, goal]), strict=True):
        if (floor.distance[tuple(np.floor(pixel + 0.5).astype(int))] + 1) * resolution < footprint.inscribed:
            raise NotFoundError(
                f"footprint: there is no room for the outline at {x:.2f},{y:.2f}: its inscribed circle has "
                f"{footprint.inscribed:g} m; give its corners in metres, or choose another place"
            )
    for clearance in np.linspace(footprint.inscribed, footprint.circumscribed, BERTHS):
        wanted = max(clearance, floor.robot_radius) + resolution * MARGIN
        path = clear_path(floor, start, goal, price, wanted)
        if path is None:
            return None
        contact = footprint.first_contact(floor, path)
        if contact is None:
            return path
    assert contact is not None, "every path that is returned has no contact"
    x, y = contact
    raise NotFoundError(
        "footprint: the outline touches an obstacle on every path that was tried, on the last near "
        f"{x:.2f},{y:.2f}; leave it out for the path of a disc, or choose another destination"
    )


def _right_and_up(pixels: NDArray) -> NDArray[np.float64]:
    """Pixel coordinates (row, column) as (right, up)."""
    return np.column_stack([pixels[:, 1], -pixels[:, 0]])


def _solid_tree(floor: Floor) -> KDTree:
    """The solid pixels beside others, right and up."""
    inner = ndimage.binary_erosion(floor.solid, np.ones((3, 3)), border_value=1)
    return KDTree(_right_and_up(np.argwhere(floor.solid & ~np.asarray(inner, bool))))
