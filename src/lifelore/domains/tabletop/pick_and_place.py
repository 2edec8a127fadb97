"""A hand that moves one object at a time on the tabletop: what it picks up and puts down settles by physics.

The hand is ideal: it reaches every place and holds every shape. It only misses the place where it puts an object
down by a few millimetres. What rests on an object when it is picked up, or moves when another is put down, is what
forces say. So a plan that was made from wrong relations fails here as it would on a table.
"""

from collections.abc import Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.relations import ADJACENT, ADJACENT_GAP, ON
from lifelore.domains.tabletop.depth_camera import KINECT
from lifelore.domains.tabletop.layout import Placed, put_beside, separation, stand, top
from lifelore.domains.tabletop.photograph import Photograph, choose_view, photograph
from lifelore.domains.tabletop.physics import Tabletop
from lifelore.domains.tabletop.pose import Pose, about
from lifelore.domains.tabletop.shapes import Shape
from lifelore.domains.tabletop.truth import SHARE, Bearing, bearing

MISS = 0.003
"""Metres: standard deviation of the place where an object is put down, along each axis of the table."""
MOVED = 0.015
"""Metres that an object may shift when another is moved; more, and it was knocked over or fell."""
ROOM = 0.12
"""Metres of table around an object that is put down apart from the others: room for a cube beside it."""
BESIDE = 0.025
"""Metres between an object that is put beside another and all others, so that it is beside no other."""
DIRECTIONS = 12
"""Number of sides on which an object may be put beside another, its faces among them."""
GAPS = (0.004, 0.011, 0.018)
"""Metres between neighbours that are put side by side, the first with room; all count as adjacent."""
CLEARANCE = 0.002
"""Metres between an object that is put on the table and what stands on others, such as the top of a tower."""
ON_TABLE, CLEAR = "on-table", "clear"
COVERED, FELL, NO_ROOM = "something rests on it", "something falls", "no room on the table"
"""Faults: an object is picked up from under another, objects do not stay where they were put, nowhere is free."""


class PickAndPlace:
    """Objects on a table and the one in the hand.

    Parameters
    ----------
    placed : sequence of Placed
        Where the objects start; they settle at once.
    generator : numpy generator
        Draws by how much the hand misses.

    Raises
    ------
    InputError
        The objects do not stay where they start.
    MissingExtraError
        MuJoCo is not installed.
    """

    def __init__(self, placed: Sequence[Placed], generator: np.random.Generator) -> None:
        self.shapes: tuple[Shape, ...] = tuple(item.shape for item in placed)
        self.poses: list[Pose] = [item.pose for item in placed]
        self.held: int | None = None
        self._generator = generator
        if (fault := self._settle()) is not None:
            raise InputError(f"placed objects must stay where they start, got: {fault}; leave more room")

    def resting_on(self, thing: int) -> tuple[int, ...]:
        """The objects of whose weight `thing` bears more than a twentieth, ascending."""
        return tuple(other for other in self._here if other != thing and self.holds(ON, other, thing))

    def holds(self, relation: str, *things: int) -> bool:
        """Whether *on*, *on-table*, *adjacent* or *clear* is true by forces and gaps; False of a held object."""
        if self.held in things:
            return False
        places = [self._here.index(thing) for thing in things]
        if relation == CLEAR:
            return not self.resting_on(*things)
        if relation == ON_TABLE:
            return bool(self._borne.share[places[0], -1] > SHARE)
        if relation == ON:
            return bool(self._borne.share[places[0], places[1]] > SHARE)
        if relation == ADJACENT:
            gap, way = self._table.distance(*places, farthest=1.0)
            return gap <= ADJACENT_GAP and bool(np.hypot(way[0], way[1]) >= abs(way[2]))
        raise InputError(f"relation must be on, on-table, adjacent or clear, got '{relation}'")

    def pick_up(self, thing: int) -> str | None:
        """Take an object off the table or another object; the fault, or None."""
        if self.resting_on(thing):
            return COVERED
        self.held = thing
        return self._settle()

    def put_on(self, thing: int, below: int) -> str | None:
        """Put the held object on the middle of another; the fault, or None."""
        base = self._placed(below)
        middle = self._missed(base.pose.position[:2])
        return self._put(thing, stand(self.shapes[thing], _yaw(base.pose), top([base])).moved(*middle))

    def put_on_table(self, thing: int) -> str | None:
        """Put the held object on the table, as near to the others as leaves `ROOM`; the fault, or None."""
        standing = stand(self.shapes[thing], _yaw(self.poses[thing]))
        others = [self._placed(other) for other in self._here]
        around = np.mean([other.pose.position[:2] for other in others], axis=0) if others else np.zeros(2)
        steps = np.arange(-0.4, 0.4001, 0.04)
        spots = around + np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
        for spot in spots[np.argsort(np.hypot(*(spots - around).T), kind="stable")]:
            item = standing.moved(*spot)
            if all(separation([item], [other]) > ROOM for other in others):
                return self._put(thing, standing.moved(*self._missed(spot)))
        return NO_ROOM

    def put_beside(self, thing: int, other: int) -> str | None:
        """Put the held object on the table beside another, at a face where there is room; the fault, or None."""
        beside = self._placed(other)
        others = [
            (self._placed(one), BESIDE if self.holds(ON_TABLE, one) else CLEARANCE)
            for one in self._here
            if one != other
        ]
        turn = _yaw(beside.pose)
        first = float(np.arctan2(turn[1, 0], turn[0, 0]))
        turns = 2 * np.pi / DIRECTIONS * np.arange(DIRECTIONS)
        # Faces first: multiples of a quarter turn.
        faces_first = first + turns[np.argsort(np.arange(DIRECTIONS) % (DIRECTIONS // 4) > 0, kind="stable")]
        for gap, direction in product(GAPS, faces_first):
            (item,) = put_beside([beside], [stand(self.shapes[thing], turn)], direction, gap)
            if all(separation([item], [one]) > room for one, room in others):
                along = abs(self._generator.normal(0, MISS)) * np.array([np.cos(direction), np.sin(direction)])
                return self._put(thing, item.moved(*along))
        return NO_ROOM

    def photograph(
        self, generator: np.random.Generator, yaw: float = 0.0, view: Pose | None = None
    ) -> Photograph | None:
        """What a depth camera sees that stands `yaw` radians around the table; None where no view holds all.

        The cloud is in the frame of the table turned by −`yaw`. `view`, where given, is a camera's pose in it.
        """
        poses = [self.poses[thing].turned(-yaw) for thing in self._here]
        table = Tabletop([self.shapes[thing] for thing in self._here], poses)
        outlines = [
            pose.apply(self.shapes[thing].outline()) for thing, pose in zip(self._here, poses, strict=True)
        ]
        view = choose_view(outlines, generator, KINECT) if view is None else view
        return None if view is None else photograph(table, outlines, view, KINECT, generator, fewest=0)

    @property
    def _here(self) -> list[int]:
        return [thing for thing in range(len(self.shapes)) if thing != self.held]

    def _placed(self, thing: int) -> Placed:
        return Placed(self.shapes[thing], self.poses[thing])

    def _missed(self, place: NDArray[np.float64]) -> tuple[float, float]:
        x, y = place + self._generator.normal(0, MISS, 2)
        return float(x), float(y)

    def _put(self, thing: int, item: Placed) -> str | None:
        self.poses[thing], self.held = item.pose, None
        return self._settle()

    def _settle(self) -> str | None:
        here = self._here
        self._table = Tabletop([self.shapes[thing] for thing in here], [self.poses[thing] for thing in here])
        calm = not here or self._table.settle()
        self._borne: Bearing = bearing(self._table.contacts(), self._table.weights)
        before = [self.poses[thing].position for thing in here]
        for thing, pose in zip(here, self._table.poses, strict=True):
            self.poses[thing] = pose
        shifts = [
            np.linalg.norm(self.poses[thing].position - old) for thing, old in zip(here, before, strict=True)
        ]
        return None if calm and max(shifts, default=0.0) <= MOVED else FELL


def _yaw(pose: Pose) -> NDArray[np.float64]:
    """The rotation about the vertical alone that is nearest to a pose's."""
    return about(2, float(np.arctan2(pose.rotation[1, 0], pose.rotation[0, 0])))
