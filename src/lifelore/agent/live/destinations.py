"""Named destinations of a building: points in metres that memory knows by name.

A record of kind "destination" holds one name: slots 0 and 1 are x and y in micrometres of the map's frame, and the
newest position counts. Its key begins with the key of the building's frame.
"""

import math
from dataclasses import dataclass

import numpy as np

from lifelore.agent.live.transitions import frame_key
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Record
from lifelore.domains.grids.grid_world import GridWorld
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

    @property
    def located_point(self) -> Point:
        """The point of a destination that `located` has looked up."""
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


def destination_record(world: GridWorld, name: str, point: Point) -> Record:
    """The record by which memory knows the name."""
    values = np.rint(np.array(point) * _MICROMETRES).astype(np.int64)
    about = {"name": name, "world": world.fingerprint}
    return Record(KIND, f"{frame_key(world)}/{name}", VERSION, "newest", np.arange(2), values, about)


def located(argument: str, destination: Destination, world: GridWorld, memory: Memory) -> Destination:
    """The destination with its point, looked up in memory if it has only a name.

    Raises
    ------
    NotFoundError
        Memory knows no such name in this building; the message lists known names.
    """
    name = destination.name
    if destination.point is not None or name is None:
        return destination
    record = memory.recall(KIND, f"{frame_key(world)}/{name}", VERSION)
    if record is not None:
        x, y = (record.values / _MICROMETRES).tolist()
        return Destination((x, y), name)
    names = known_names(world, memory)
    listed = ", ".join(names[:_SHOWN]) + (" …" if len(names) > _SHOWN else "")
    known = f"memory knows {listed}" if names else "memory knows no names here"
    raise NotFoundError(
        f"{argument}: no destination of this building is named '{name}'; {known}; give X,Y in metres, "
        "or name places in a job list of `lifelore live --goals`"
    )


def known_names(world: GridWorld, memory: Memory) -> list[str]:
    """Names of destinations of this building, sorted."""
    frame = frame_key(world) + "/"
    return sorted(key.removeprefix(frame) for key, _, _ in memory.keys(KIND) if key.startswith(frame))
