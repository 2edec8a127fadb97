"""Shapes of the tabletop as plain data: each a handful of convex parts, sizes in metres.

`ShapePart` is a box (half sizes), cylinder (radius, half height), ball (radius), ellipsoid (three radii), capsule
(radius, half length) or the convex hull of `vertices`. Axes of cylinders and capsules are their local z.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.tabletop.pose import about, aligned

BOX, CYLINDER, BALL, ELLIPSOID, CAPSULE, HULL = "box", "cylinder", "ball", "ellipsoid", "capsule", "hull"
_CIRCLE = np.array([[np.cos(t), np.sin(t)] for t in np.linspace(0, 2 * np.pi, 16, endpoint=False)])
_SPHERE = np.array(
    [
        [np.cos(t) * np.cos(e), np.sin(t) * np.cos(e), np.sin(e)]
        for e in np.linspace(-np.pi / 2, np.pi / 2, 7)
        for t in np.linspace(0, 2 * np.pi, 12, endpoint=False)
    ]
)


@dataclass(frozen=True, eq=False)
class ShapePart:
    """One convex piece of a shape, in the shape's frame."""

    kind: str
    size: tuple[float, ...]
    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    vertices: NDArray[np.float64] | None = None

    def outline(self) -> NDArray[np.float64]:
        """Points ``(m, 3)`` whose convex hull is the part, or for round parts nearly so."""
        return self._local() @ self.rotation.T + self.position

    def _local(self) -> NDArray[np.float64]:
        if self.vertices is not None:
            return self.vertices
        if self.kind == BOX:
            corners = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
            return corners * self.size
        if self.kind == CYLINDER:
            radius, half = self.size
            rims = [np.column_stack([radius * _CIRCLE, np.full(16, z)]) for z in (-half, half)]
            return np.concatenate(rims)
        if self.kind == CAPSULE:
            radius, half = self.size
            return np.concatenate([radius * _SPHERE + [0, 0, z] for z in (-half, half)])
        return _SPHERE * (self.size if self.kind == ELLIPSOID else self.size[0])


@dataclass(frozen=True)
class Hinge:
    """Parts from `first_part` on are a second body that turns about `axis` through `position`, radians."""

    first_part: int
    position: tuple[float, float, float]
    axis: tuple[float, float, float]
    limits: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Shape:
    """One object: a kind for humans, its parts, its density in kg/m³ and perhaps a hinge within."""

    kind: str
    parts: tuple[ShapePart, ...]
    density: float = 400.0
    hinge: Hinge | None = None

    def outline(self) -> NDArray[np.float64]:
        """Points ``(m, 3)`` that span the shape in its own frame."""
        return np.concatenate([part.outline() for part in self.parts])

    def moved(self, shift: NDArray[np.float64]) -> "Shape":
        """The same shape about another origin."""
        parts = tuple(replace(p, position=p.position + shift) for p in self.parts)
        hinge = self.hinge
        if hinge is not None:
            hinge = replace(hinge, position=_triple(np.asarray(hinge.position) + shift))
        return replace(self, parts=parts, hinge=hinge)

    def turned(self, turn: NDArray[np.float64]) -> "Shape":
        """The same shape about other axes: `turn` ``(3, 3)`` carries its old ones to the new."""
        parts = tuple(replace(p, position=turn @ p.position, rotation=turn @ p.rotation) for p in self.parts)
        hinge = self.hinge
        if hinge is not None:
            place, axis = (_triple(turn @ np.array(u)) for u in (hinge.position, hinge.axis))
            hinge = replace(hinge, position=place, axis=axis)
        return replace(self, parts=parts, hinge=hinge)

    def centred(self) -> "Shape":
        """The same shape about the middle of its outline."""
        outline = self.outline()
        return self.moved(-(outline.min(axis=0) + outline.max(axis=0)) / 2)


def _triple(values: NDArray[np.float64]) -> tuple[float, float, float]:
    x, y, z = values
    return float(x), float(y), float(z)


def part(kind: str, size: tuple[float, ...], position=(0.0, 0.0, 0.0), rotation=None) -> ShapePart:
    """A part without writing arrays."""
    turn = np.eye(3) if rotation is None else rotation
    return ShapePart(kind, tuple(float(s) for s in size), np.asarray(position, dtype=float), turn)


def hull(vertices: NDArray[np.float64]) -> ShapePart:
    """The convex hull of some points as a part."""
    return ShapePart(HULL, (), np.zeros(3), np.eye(3), np.asarray(vertices, dtype=float))


def box(length: float, width: float, height: float, kind: str = "box") -> Shape:
    """A block, metres along x, y and z."""
    return Shape(kind, (part(BOX, (length / 2, width / 2, height / 2)),))


def cylinder(radius: float, height: float) -> Shape:
    """A can that stands along z."""
    return Shape("cylinder", (part(CYLINDER, (radius, height / 2)),))


def ball(radius: float) -> Shape:
    """A ball."""
    return Shape("ball", (part(BALL, (radius,)),))


def ellipsoid(a: float, b: float, c: float) -> Shape:
    """An ellipsoid of three radii."""
    return Shape("ellipsoid", (part(ELLIPSOID, (a, b, c)),))


def l_block(length: float, width: float, height: float, foot: float, upright: float) -> Shape:
    """A foot of `length` × `width`, `foot` thick, and an upright of thickness `upright` at its −x end.

    `height` is the whole height. The origin is in the middle of the surrounding box.
    """
    rise = height - foot
    return Shape(
        "l_block",
        (
            part(BOX, (length / 2, width / 2, foot / 2), (0, 0, (foot - height) / 2)),
            part(BOX, (upright / 2, width / 2, rise / 2), ((upright - length) / 2, 0, foot / 2)),
        ),
    )


def arch(length: float, width: float, height: float, foot: float, plate: float) -> Shape:
    """A bridge: a plate on two feet at its ends, each `foot` long; `height` is the whole height."""
    leg = height - plate
    legs = [
        part(BOX, (foot / 2, width / 2, leg / 2), (side * (length - foot) / 2, 0, -plate / 2)) for side in (-1, 1)
    ]
    return Shape("arch", (part(BOX, (length / 2, width / 2, plate / 2), (0, 0, leg / 2)), *legs))


def hinged_blocks(
    length: float, width: float, height: float, angle: float, turn: NDArray[np.float64] | None = None
) -> Shape:
    """Two equal blocks joined by a rotary joint about y at their common end, `angle` radians from straight.

    At angle 0 they lie in line along x; a positive angle lowers the far end of the second. `turn` about y then
    turns the whole.
    """
    first = part(BOX, (length / 2, width / 2, height / 2), (-length / 2, 0, 0))
    bend = about(1, angle)
    second = part(BOX, (length / 2, width / 2, height / 2), bend @ np.array([length / 2, 0, 0]), bend)
    shape = Shape("hinged_blocks", (first, second), hinge=Hinge(1, (0, 0, 0), (0, 1, 0), (-1.5, 1.5)))
    return shape if turn is None else shape.turned(turn)


def torus(ring: float, tube: float, pieces: int = 16) -> Shape:
    """A ring of radius `ring` made of capsules of radius `tube`, flat in x-y."""
    half = ring * np.sin(np.pi / pieces)
    parts = []
    for angle in np.linspace(0, 2 * np.pi, pieces, endpoint=False):
        along = np.array([-np.sin(angle), np.cos(angle), 0])
        centre = ring * np.cos(np.pi / pieces) * np.array([np.cos(angle), np.sin(angle), 0])
        parts.append(part(CAPSULE, (tube, half), centre, aligned(along)))
    return Shape("torus", tuple(parts))


def cup(low: float, high: float, height: float, wall: float, handle: bool, kind: str = "mug") -> Shape:
    """An open vessel: a floor, a wall of 16 slabs that opens from radius `low` to `high`, and maybe a handle."""
    pieces = 16
    lean = np.arctan2(high - low, height)
    middle = (low + high) / 2
    slabs = [part(CYLINDER, (low, wall / 2), (0, 0, (wall - height) / 2))]
    for angle in np.linspace(0, 2 * np.pi, pieces, endpoint=False):
        turn = about(2, angle) @ about(1, lean)
        centre = about(2, angle) @ np.array([middle - wall / 2, 0, 0])
        half = (wall / 2, max(low, high) * np.tan(np.pi / pieces), height / 2 / np.cos(lean))
        slabs.append(part(BOX, half, centre, turn))
    return Shape(kind, (*slabs, *(_handle(middle, height, wall) if handle else ())), density=800.0)


def _handle(radius: float, height: float, wall: float) -> list[ShapePart]:
    bow, tube = 0.33 * height, max(wall * 0.9, 0.0045)
    angles = np.linspace(-np.pi / 2, np.pi / 2, 8)
    rim = np.stack([radius + bow * np.cos(angles), np.zeros(8), bow * np.sin(angles)], axis=1)
    return [
        part(CAPSULE, (tube, float(np.linalg.norm(b - a)) / 2), (a + b) / 2, aligned(b - a))
        for a, b in pairwise(rim)
    ]


def wedge(length: float, width: float, height: float) -> Shape:
    """A ramp: full height at −x, nothing at +x."""
    x, y, z = length / 2, width / 2, height / 2
    corners = [[s * x, t * y, -z] for s in (-1, 1) for t in (-1, 1)] + [[-x, t * y, z] for t in (-1, 1)]
    return Shape("wedge", (hull(np.array(corners)),))


def prism(sides: int, radius: float, height: float) -> Shape:
    """A regular prism that stands along z."""
    angles = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    rim = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    corners = np.concatenate([np.column_stack([rim, np.full(sides, z)]) for z in (-height / 2, height / 2)])
    return Shape("prism", (hull(corners),))


def cone(low: float, high: float, height: float) -> Shape:
    """A blunt cone of radius `low` at the bottom and `high` at the top."""
    rims = [(low, -height / 2), (high, height / 2)]
    return Shape(
        "cone", (hull(np.concatenate([np.column_stack([r * _CIRCLE, np.full(16, z)]) for r, z in rims])),)
    )


def stone(points: NDArray[np.float64]) -> Shape:
    """The convex hull of random points."""
    return Shape("stone", (hull(points),), density=1500.0)


def stairs(length: float, width: float, height: float, steps: int) -> Shape:
    """Steps of equal tread that rise towards −x; the origin is in the middle of the surrounding box."""
    tread = length / steps
    parts = []
    for k in range(steps):
        rise = height * (steps - k) / steps
        place = ((k + 0.5) * tread - length / 2, 0, (rise - height) / 2)
        parts.append(part(BOX, (tread / 2, width / 2, rise / 2), place))
    return Shape("stairs", tuple(parts))


def paddle(length: float, broad: float, narrow: float, height: float) -> Shape:
    """A board along x that tapers from `broad` to `narrow`."""
    rim = [(s * length / 2, t * w / 2) for s, w in ((-1, broad), (1, narrow)) for t in (-1, 1)]
    return Shape("paddle", (hull(np.array([(x, y, z) for x, y in rim for z in (-height / 2, height / 2)])),))


def cross(length: float, width: float, height: float) -> Shape:
    """Two bars across one another, flat."""
    arms = [part(BOX, (length / 2, width / 2, height / 2)), part(BOX, (width / 2, length / 2, height / 2))]
    return Shape("cross", tuple(arms))
