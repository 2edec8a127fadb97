"""The plan of an invented office floor: corridors, the rooms along them, and their doors.

Every room lies along a corridor and opens onto it, so a plan is connected by construction. Rooms tile the
floor edge to edge; walls are drawn inside a room's rectangle, corridors have none of their own.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

Side = Literal["top", "bottom", "left", "right"]
Kind = Literal["office", "shared", "meeting", "kitchen", "lounge", "storage", "washroom", "open", "shaft"]

WALL = 0.1
"""Thickness in metres of a room's own wall; two rooms side by side make 0.2."""
_DEEPEST_ROW = 7.2
_WIDTHS: dict[Kind, tuple[float, float]] = {
    "office": (2.8, 3.8),
    "shared": (4.6, 6.6),
    "meeting": (4.0, 6.0),
    "kitchen": (4.0, 5.5),
    "lounge": (4.0, 6.0),
    "storage": (2.4, 3.2),
    "washroom": (3.0, 4.0),
    "open": (7.0, 11.0),
    "shaft": (2.4, 4.0),
}
_SHARES = (0.36, 0.2, 0.13, 0.06, 0.04, 0.06, 0.05, 0.06, 0.04)


class Rect(NamedTuple):
    """x0 <= x1 to the right, y0 <= y1 downwards, in metres."""

    x0: float
    y0: float
    x1: float
    y1: float

    def seen_from(self, side: Side) -> tuple[float, float]:
        """Length along `side` and depth away from it."""
        width, height = self.x1 - self.x0, self.y1 - self.y0
        return (width, height) if side in ("top", "bottom") else (height, width)

    def part(self, side: Side, u0: float, v0: float, u1: float, v1: float) -> "Rect":
        """The part from u0 to u1 along `side` and from v0 to v1 away from it."""
        if side == "top":
            return Rect(self.x0 + u0, self.y0 + v0, self.x0 + u1, self.y0 + v1)
        if side == "bottom":
            return Rect(self.x0 + u0, self.y1 - v1, self.x0 + u1, self.y1 - v0)
        if side == "left":
            return Rect(self.x0 + v0, self.y0 + u0, self.x0 + v1, self.y0 + u1)
        return Rect(self.x1 - v1, self.y0 + u0, self.x1 - v0, self.y0 + u1)


class Room(NamedTuple):
    """A room, the side its corridor runs along, and its doors as (from, to) along that side."""

    rect: Rect
    kind: Kind
    side: Side
    doors: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class OfficePlan:
    """Corridors and rooms tile the floor; `passages` are openings between rooms."""

    corridors: tuple[Rect, ...]
    rooms: tuple[Room, ...]
    passages: tuple[Rect, ...]


def plan_office(generator: np.random.Generator, width: float, height: float) -> OfficePlan:
    """Invent the plan of a floor that fits into `width` × `height` metres."""
    draft = _Draft(generator)
    layouts = [draft.spine]
    if width >= 22 and height >= 18:
        layouts += [draft.ladder, draft.comb, draft.comb]
    layouts[generator.integers(len(layouts))](Rect(0.0, 0.0, width, height))
    return OfficePlan(tuple(draft.corridors), tuple(draft.rooms), tuple(draft.passages))


class _Draft:
    """A plan in the making."""

    def __init__(self, generator: np.random.Generator) -> None:
        self.generator = generator
        self.corridors: list[Rect] = []
        self.rooms: list[Room] = []
        self.passages: list[Rect] = []

    def between(self, low: float, high: float) -> float:
        """A length in whole decimetres, so that walls fall on pixels."""
        return round(float(self.generator.uniform(low, high)), 1)

    def spine(self, floor: Rect) -> None:
        """One corridor from end to end."""
        corridor = self.between(1.8, 2.4)
        y = round(floor.y0 + (floor.y1 - floor.y0 - corridor) * self.between(0.3, 0.7), 1)
        self.corridors.append(Rect(floor.x0, y, floor.x1, y + corridor))
        self.fill(Rect(floor.x0, floor.y0, floor.x1, y), "bottom")
        self.fill(Rect(floor.x0, y + corridor, floor.x1, floor.y1), "top")

    def ladder(self, floor: Rect) -> None:
        """Two long corridors, two cross ones, rooms around a core or a courtyard."""
        depth, corridor = self.between(4.4, 5.6), self.between(1.7, 2.1)
        x0, x1 = floor.x0 + depth, floor.x1 - depth
        y0, y1 = floor.y0 + depth, floor.y1 - depth
        self.corridors += [Rect(floor.x0, y0, floor.x1, y0 + corridor)]
        self.corridors += [Rect(floor.x0, y1 - corridor, floor.x1, y1)]
        inner = Rect(x0 + corridor, y0 + corridor, x1 - corridor, y1 - corridor)
        self.corridors += [Rect(x0, inner.y0, inner.x0, inner.y1), Rect(inner.x1, inner.y0, x1, inner.y1)]
        self.fill(Rect(floor.x0, floor.y0, floor.x1, y0), "bottom")
        self.fill(Rect(floor.x0, y1, floor.x1, floor.y1), "top")
        self.fill(Rect(floor.x0, inner.y0, x0, inner.y1), "right")
        self.fill(Rect(x1, inner.y0, floor.x1, inner.y1), "left")
        self.core(inner)

    def core(self, block: Rect) -> None:
        """The inside of a ladder: a courtyard, one row of rooms, or two back to back."""
        if self.generator.random() < 0.25:
            self.rooms.append(Room(block, "shaft", "top", ()))
        elif block.y1 - block.y0 <= _DEEPEST_ROW:
            self.fill(block, "top")
        else:
            middle = round((block.y0 + block.y1) / 2, 1)
            self.fill(block._replace(y1=middle), "top")
            self.fill(block._replace(y0=middle), "bottom")

    def comb(self, floor: Rect) -> None:
        """A bar with one or two legs: the floor has the shape of an L, a T or a U."""
        corridor = self.between(1.8, 2.3)
        upper, lower = self.between(4.6, 6.2), self.between(4.6, 6.2)
        y, bottom = floor.y0 + upper, floor.y0 + upper + corridor + lower
        self.corridors.append(Rect(floor.x0, y, floor.x1, y + corridor))
        self.fill(Rect(floor.x0, floor.y0, floor.x1, y), "bottom")
        free_from = floor.x0
        for leg, x in self.leg_corridors(floor, corridor):
            self.corridors.append(Rect(x, y + corridor, x + corridor, floor.y1))
            self.fill(Rect(leg[0], bottom, x, floor.y1), "right")
            self.fill(Rect(x + corridor, bottom, leg[1], floor.y1), "left")
            self.fill(Rect(free_from, y + corridor, x, bottom), "top")
            free_from = x + corridor
        self.fill(Rect(free_from, y + corridor, floor.x1, bottom), "top")

    def leg_corridors(self, floor: Rect, corridor: float):
        """Where a comb's legs stand: ((from, to), left edge of the corridor) along the bar."""
        span = [self.between(4.4, 5.6) * 2 + corridor for _ in range(2)]
        room = floor.x1 - floor.x0 - span[0]
        if room - span[1] >= 4 and self.generator.random() < 0.5:
            starts = [floor.x0, floor.x1 - span[1]]
        else:
            starts = [floor.x0 + round(room * float(self.generator.choice([0.0, 0.5, 1.0])), 1)]
        return [((x, x + w), x + (w - corridor) / 2) for x, w in zip(starts, span, strict=False)]

    def fill(self, block: Rect, side: Side) -> None:
        """Rooms for a block with a corridor along `side`: one row, or wings where it is deep."""
        length, depth = block.seen_from(side)
        if depth <= _DEEPEST_ROW:
            self.row(block, side)
            return
        n = max(1, round(length / 13))
        edges = [round(length * i / n, 1) for i in range(n + 1)]
        for u0, u1 in pairwise(edges):
            module = block.part(side, u0, 0, u1, depth)
            if depth <= 12 and self.generator.random() < 0.35:
                self.add_room(module, "open", side)
            else:
                self.wing(module, side)

    def wing(self, module: Rect, side: Side) -> None:
        """A corridor that leaves the one along `side`, with rooms to its left and right."""
        length, depth = module.seen_from(side)
        corridor = self.between(1.6, 2.0)
        one_sided = length < 8.5
        left = length - corridor if one_sided else round((length - corridor) * self.between(0.4, 0.6), 1)
        lower, upper = ("right", "left") if side in ("top", "bottom") else ("bottom", "top")
        self.corridors.append(module.part(side, left, 0, left + corridor, depth))
        self.fill(module.part(side, 0, 0, left, depth), lower)
        if not one_sided:
            self.fill(module.part(side, left + corridor, 0, length, depth), upper)

    def row(self, block: Rect, side: Side) -> None:
        """Rooms side by side along a corridor; their widths are stretched to fill it."""
        length, depth = block.seen_from(side)
        kinds, widths = self.kinds_along(length)
        edges = [round(edge, 1) for edge in np.cumsum([0.0, *widths]) * (length / sum(widths))]
        for kind, u0, u1 in zip(kinds, edges[:-1], edges[1:], strict=True):
            self.add_room(block.part(side, u0, 0, u1, depth), kind, side)
        for before, after, edge in zip(kinds[:-1], kinds[1:], edges[1:-1], strict=True):
            joined = {before, after} <= {"office", "shared", "meeting"} and self.generator.random() < 0.15
            if joined and depth > 3:
                self.passages.append(block.part(side, edge - 0.2, 1.2, edge + 0.2, 2.1))

    def kinds_along(self, length: float) -> tuple[list[Kind], list[float]]:
        kinds: list[Kind] = []
        widths: list[float] = []
        names = list(_WIDTHS)
        while not kinds or length - sum(widths) >= 2.4:
            kind = names[self.generator.choice(len(names), p=_SHARES)]
            again = kinds[-1:] == [kind] and kind not in ("office", "shared")
            if not again and (not kinds or sum(widths) + _WIDTHS[kind][0] <= length + 0.6):
                kinds.append("office" if kind == "shaft" and length < 8 else kind)
                widths.append(self.between(*_WIDTHS[kind]))
        return kinds, widths

    def add_room(self, rect: Rect, kind: Kind, side: Side) -> None:
        length, _ = rect.seen_from(side)
        doors: list[tuple[float, float]] = []
        if kind == "open":
            doors.append((WALL, length - WALL))
        elif kind != "shaft":
            wide = 0.9 if kind in ("office", "storage", "washroom") else 1.0
            halves = [(0.0, length)] if length < 5.5 else [(0.0, length / 2), (length / 2, length)]
            for low, high in halves:
                at = self.between(low + 0.3, max(low + 0.3, high - wide - 0.3))
                doors.append((at, at + wide))
            if len(doors) == 2 and self.generator.random() < 0.5:
                doors.pop(int(self.generator.integers(2)))
        self.rooms.append(Room(rect, kind, side, tuple(doors)))
