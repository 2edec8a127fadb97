"""Objects put on a table before they settle: standing on something, or side by side at a gap."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.tabletop.pose import Pose, about, random_rotation
from lifelore.domains.tabletop.shapes import Shape

CLEARANCE = 0.0008
"""Metres between surfaces before the drop."""
_DIRECTIONS = np.array([[np.cos(t), np.sin(t)] for t in np.linspace(0, 2 * np.pi, 720, endpoint=False)])


@dataclass(frozen=True, eq=False)
class Placed:
    """A shape and where it starts."""

    shape: Shape
    pose: Pose

    def outline(self) -> NDArray[np.float64]:
        """Points ``(m, 3)`` that span it in the world."""
        return self.pose.apply(self.shape.outline())

    def moved(self, x: float, y: float, z: float = 0.0) -> "Placed":
        """The same object further on."""
        return Placed(self.shape, self.pose.moved(np.array([x, y, z])))

    def turned(self, yaw: float) -> "Placed":
        """The same object carried about the vertical through the origin."""
        return Placed(self.shape, self.pose.turned(yaw))


Group = list[Placed]


def top(group: Sequence[Placed]) -> float:
    """Height of the highest point, metres."""
    return max(float(item.outline()[:, 2].max()) for item in group)


def middle(group: Sequence[Placed]) -> NDArray[np.float64]:
    """Middle (x, y) of the surrounding box."""
    points = _footprint(group)
    return (points.min(axis=0) + points.max(axis=0)) / 2


def stand(shape: Shape, rotation: NDArray[np.float64] | None = None, height: float = 0.0) -> Placed:
    """The shape turned, over the origin, its lowest point just above `height`."""
    rotation = np.eye(3) if rotation is None else rotation
    outline = shape.outline() @ rotation.T
    x, y, _ = (outline.min(axis=0) + outline.max(axis=0)) / 2
    return Placed(shape, Pose(np.array([-x, -y, height + CLEARANCE - outline[:, 2].min()]), rotation))


def rest(rng: np.random.Generator, shape: Shape) -> NDArray[np.float64]:
    """A turn in which such a shape may stand or lie; flat more often than on edge, any yaw."""
    return about(2, rng.uniform(0, 2 * np.pi)) @ _upright(rng, shape)


def _upright(rng: np.random.Generator, shape: Shape) -> NDArray[np.float64]:
    quarter, chance = np.pi / 2, rng.random()
    if shape.kind in ("box", "carton", "slab", "l_block", "paddle"):
        flat = 0.85 if shape.kind in ("slab", "paddle") else 0.5
        return np.eye(3) if chance < flat else about(int(rng.integers(2)), quarter)
    if shape.kind in ("cylinder", "prism", "cone"):
        return np.eye(3) if chance < 0.7 else about(0, quarter)
    if shape.kind in ("bowl", "mug", "arch"):
        return np.eye(3) if chance < 0.85 else about(0, np.pi)
    if shape.kind in ("stone", "ellipsoid"):
        return random_rotation(rng) if chance < 0.5 else np.eye(3)
    return np.eye(3)


def put_beside(still: Group, moving: Group, direction: float, gap: float) -> Group:
    """`moving` carried over the table in `direction` (radians) from `still` until `gap` metres are between them.

    Exact to a quarter of a degree of the footprints' convex hulls: their distance is the largest room over all
    directions, and room grows with the way at the cosine of each.
    """
    way = np.array([np.cos(direction), np.sin(direction)])
    start = middle(still) - middle(moving)
    ahead = _DIRECTIONS @ way
    use = ahead > 0.05
    room = _rooms(still, moving) + _DIRECTIONS @ start
    distance = float(((gap - room[use]) / ahead[use]).min())
    shift = start + distance * way
    return [item.moved(float(shift[0]), float(shift[1])) for item in moving]


def separation(first: Group, second: Group) -> float:
    """Distance between the footprints' convex hulls, metres; negative where they overlap."""
    return float(_rooms(first, second).max())


def _rooms(first: Group, second: Group) -> NDArray[np.float64]:
    return (_footprint(second) @ _DIRECTIONS.T).min(axis=0) - (_footprint(first) @ _DIRECTIONS.T).max(axis=0)


def _footprint(group: Sequence[Placed]) -> NDArray[np.float64]:
    return np.concatenate([item.outline()[:, :2] for item in group])
