"""Named destinations of a building: points in metres that memory knows by name.

A record of kind "destination" holds one name: slots 0 and 1 are x and y in micrometres, in the frame of the
building's first map, and the newest position counts. Its key begins with the key of the building.
"""

import math
from dataclasses import dataclass

import numpy as np

from lifelore.agent.building_record import joined_buildings
from lifelore.agent.live.buildings.recognition import Place
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Record
from lifelore.domains.buildings.registration import IDENTITY, Pose, composed, inverse, moved
from lifelore.memory import Memory

KIND, VERSION = "destination", 1
LONGEST_NAME = 100
LARGEST = 1e6
"""Metres: a larger coordinate is a typing mistake."""
_MICROMETRES = 1_000_000
_SHOWN = 10

Point = tuple[float, float]
"""x and y in metres of the map's frame; row and column in worlds without metres."""


@dataclass(frozen=True)
class Destination:
    """A point of a building, or a name that memory knows, or both: a name for the point.

    Raises
    ------
    InputError
        Both are missing, a coordinate is not finite, or the name breaks its rule.
    """

    point: Point | None = None
    name: str | None = None

    def __post_init__(self) -> None:
        if self.point is None and self.name is None:
            raise InputError("a destination must have a point X,Y or a name, got neither")
        if self.point is not None and not all(math.isfinite(x) and abs(x) <= LARGEST for x in self.point):
            raise InputError(
                f"a destination must have coordinates of magnitude {LARGEST:g} at most, "
                f"got {self.point[0]:g},{self.point[1]:g}"
            )
        name = self.name
        if name is not None and not (
            name.strip() == name and name and name.isprintable() and len(name) <= LONGEST_NAME
        ):
            raise InputError(
                f"a destination's name must be 1 to {LONGEST_NAME} printable characters without spaces around it, "
                f"got {name[:40]!r}"
            )

    @classmethod
    def of(cls, place: "Destination | Point | str") -> "Destination":
        """A destination as it is, a name, or a point of any two numbers."""
        if isinstance(place, Destination):
            return place
        if isinstance(place, str):
            return cls(name=place)
        try:
            x, y = map(float, place)
        except (TypeError, ValueError):
            raise InputError(f"a place must be a name or two numbers, got {place!r:.60}") from None
        return cls((x, y))

    @property
    def located_point(self) -> Point:
        """The point of a destination that `NamedPlaces.located` has looked up."""
        assert self.point is not None, "look the name up first"
        return self.point

    def __str__(self) -> str:
        return self.name or ("" if self.point is None else f"{self.point[0]:g},{self.point[1]:g}")


def destination_from_text(argument: str, text: str) -> Destination:
    """The point ``X,Y``, or otherwise the name, that a user wrote for `argument`."""
    parts = text.split(",")
    try:
        x, y = (float(part) for part in parts)
    except ValueError:
        if len(parts) > 1 or not text.strip():
            raise InputError(
                f"{argument} must be X,Y, two numbers in metres of the map's frame, or a known name, got '{text}'"
            ) from None
        return Destination(name=text.strip())
    return Destination((x, y))


@dataclass(frozen=True)
class NamedPlaces:
    """The names of one building; every map of the building shares them.

    key : of the building in memory, or of the frame of a world in no building
    pose : from the map's frame to that of the building's first map
    """

    key: str
    pose: Pose = IDENTITY

    @classmethod
    def of(cls, place: Place) -> "NamedPlaces":
        """The names of a place's building."""
        pose = place.report and place.report["pose"]
        return cls(place.grid.building or place.grid.frame, tuple(pose) if pose else IDENTITY)

    def record(self, name: str, point: Point) -> Record:
        """The record by which memory knows a point by its name from then on."""
        values = np.rint(moved(self.pose, np.array([point]))[0] * _MICROMETRES).astype(np.int64)
        about = {"name": name, "building": self.key}
        return Record(KIND, f"{self.key}/{name}", VERSION, "newest", np.arange(2), values, about)

    def located(self, argument: str, destination: Destination, memory: Memory) -> Destination:
        """The destination with its point, looked up in memory if it has only a name.

        Raises
        ------
        NotFoundError
            Memory knows no such name in this building; the message lists known names.
        """
        name = destination.name
        if destination.point is not None or name is None:
            return destination
        point = self.remembered(name, memory)
        if point is not None:
            return Destination(point, name)
        names = self.names(memory)
        listed = ", ".join(names[:_SHOWN]) + (" …" if len(names) > _SHOWN else "")
        known = f"memory knows {listed}" if names else "memory knows no names here"
        raise NotFoundError(
            f"{argument}: no destination of this building is named '{name}'; {known}; give X,Y in metres, "
            "or name places in a job list of `lifelore live --goals`"
        )

    def remembered(self, name: str, memory: Memory) -> Point | None:
        """The point in the map's frame that memory knows by a name; None if it does not know the name."""
        for key, pose in self._frames(memory).items():
            if record := memory.recall(KIND, f"{key}/{name}", VERSION):
                there = composed(inverse(self.pose), pose)
                x, y = moved(there, record.values[None] / _MICROMETRES)[0].round(6).tolist()
                return x, y
        return None

    def names(self, memory: Memory) -> list[str]:
        """The names that memory knows, sorted."""
        frames, keys = self._frames(memory), (key.split("/", 1) for key, _, _ in memory.keys(KIND))
        return sorted({name for key, name in keys if key in frames})

    def points(self, memory: Memory) -> dict[str, Point]:
        """The points in the map's frame that memory knows, by name."""
        found = ((name, self.remembered(name, memory)) for name in self.names(memory))
        return {name: point for name, point in found if point is not None}

    def _frames(self, memory: Memory) -> dict[str, Pose]:
        """Poses in the frame of the building, of it and of those that were joined to it, by key."""
        joined = joined_buildings(memory).items()
        return {self.key: IDENTITY} | {key: one.pose for key, one in joined if one.home.key == self.key}
