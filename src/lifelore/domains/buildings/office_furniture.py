"""What stands in an invented office's rooms, as a laser at knee height would see it.

Pieces are rectangles ``(u0, v0, u1, v1)`` in metres within the room's walls: u along the corridor's side, v
away from it. They stand against a wall or each other, or leave a walkway; none stands before a door.
"""

from collections.abc import Callable, Iterator

import numpy as np

from lifelore.domains.buildings.office_plan import Kind

Piece = tuple[float, float, float, float]

_DOOR_CLEARANCE = 1.0
_CHAIR = 0.45
_TUCKED = 0.2  # how far a chair is pushed under its table


def furnish(
    kind: Kind, length: float, depth: float, doors: list[tuple[float, float]], generator: np.random.Generator
) -> list[Piece]:
    """Pieces of furniture for a room; `doors` are (from, to) along the corridor's side."""
    pieces = []
    for u0, v0, u1, v1 in () if kind == "shaft" else _FURNITURE[kind](length, depth, generator):
        inside = u0 >= -1e-9 and v0 >= -1e-9 and u1 <= length + 1e-9 and v1 <= depth + 1e-9
        in_the_way = v0 < _DOOR_CLEARANCE and any(u0 < b + 0.2 and u1 > a - 0.2 for a, b in doors)
        if inside and not (in_the_way and kind != "open"):
            pieces.append((u0, v0, u1, v1))
    return pieces


def _chair(u: float, v: float) -> Piece:
    return (u - _CHAIR / 2, v - _CHAIR / 2, u + _CHAIR / 2, v + _CHAIR / 2)


def _table_with_chairs(u0: float, v0: float, u1: float, v1: float, generator) -> Iterator[Piece]:
    """A table and chairs along its two longer sides, a few of them missing."""
    yield u0, v0, u1, v1
    out = _CHAIR / 2 - _TUCKED
    along_u = u1 - u0 >= v1 - v0
    start, end = (u0, u1) if along_u else (v0, v1)
    n = max(1, int((end - start) / 0.8))
    for at in start + (np.arange(n) + 0.5) * (end - start) / n:
        for edge in (v0 - out, v1 + out) if along_u else (u0 - out, u1 + out):
            if generator.random() < 0.85:
                yield _chair(at, edge) if along_u else _chair(edge, at)


def _office(length: float, depth: float, generator) -> Iterator[Piece]:
    mirrored = generator.random() < 0.5

    def piece(u0, v0, u1, v1):
        return (length - u1, v0, length - u0, v1) if mirrored else (u0, v0, u1, v1)

    if generator.random() < 0.6:
        yield piece(0.0, depth - 2.2, 0.8, depth - 0.6)
        yield piece(0.85, depth - 1.6, 1.3, depth - 1.15)
        if length > 3.1 and generator.random() < 0.5:
            yield piece(length - 0.8, depth - 2.2, length, depth - 0.6)
    else:
        yield piece(0.0, depth - 1.9, 1.6, depth - 1.1)
        yield piece(0.6, depth - 0.95, 1.05, depth - 0.5)
    if generator.random() < 0.7:
        yield piece(length - 0.4, 1.2, length, min(2.4, depth - 2.4))


def _shared(length: float, depth: float, generator) -> Iterator[Piece]:
    columns = 2 if length >= 5.4 else 1
    u0, v0 = (length - 1.6 * columns) / 2, (depth - 1.6) / 2 + 0.3
    yield from _table_with_chairs(u0, v0, u0 + 1.6 * columns, v0 + 1.6, generator)
    if generator.random() < 0.6:
        yield 0.0, depth - 0.4, float(generator.uniform(1.0, 1.8)), depth
    if generator.random() < 0.5:
        yield length - 0.4, 1.2, length, 2.0


def _meeting(length: float, depth: float, generator) -> Iterator[Piece]:
    long_u = length >= depth
    half_u = min((length - 2.4) / 2, 1.8 if long_u else 0.6)
    half_v = min((depth - 2.6) / 2, 0.6 if long_u else 1.8)
    u, v = length / 2, depth / 2 + 0.1
    yield from _table_with_chairs(u - half_u, v - half_v, u + half_u, v + half_v, generator)
    if generator.random() < 0.4:
        yield 0.0, depth - 0.4, 1.2, depth


def _kitchen(length: float, depth: float, generator) -> Iterator[Piece]:
    yield 0.0, depth - 0.6, length * float(generator.uniform(0.6, 1.0)), depth
    for u in np.arange(1.3, length - 1.0, 2.3):
        for v in np.arange(1.7, depth - 2.1, 2.3):
            if generator.random() < 0.8:
                yield from _table_with_chairs(u - 0.4, v - 0.4, u + 0.4, v + 0.4, generator)


def _lounge(length: float, depth: float, generator) -> Iterator[Piece]:
    yield 0.0, depth - 2.6, 0.9, depth - 0.5
    yield length - 0.9, depth - 2.6, length, depth - 0.5
    yield length / 2 - 0.5, depth - 1.9, length / 2 + 0.5, depth - 1.3
    if generator.random() < 0.6:
        yield length - 0.5, 0.0, length, 0.5


def _storage(length: float, depth: float, generator) -> Iterator[Piece]:
    yield 0.0, 1.1, 0.45, depth
    yield length - 0.45, 1.1, length, depth


def _washroom(length: float, depth: float, generator) -> Iterator[Piece]:
    stalls = int(length / 1.0)
    wide = length / stalls
    for index in range(1, stalls):
        yield index * wide - 0.05, depth - 1.5, index * wide + 0.05, depth
    for index in range(stalls):
        yield index * wide + wide / 2 - 0.2, depth - 0.6, index * wide + wide / 2 + 0.2, depth
    yield 0.0, 1.2, 0.5, max(1.3, depth - 2.4)


def _open(length: float, depth: float, generator) -> Iterator[Piece]:
    """Blocks of desks with walkways of more than a metre around, with some places free for other furniture."""
    columns = int(generator.integers(1, 3))
    pitch_u, pitch_v = 1.6 * columns + 1.5, 1.6 + 1.9
    n_u, n_v = max(1, int((length - 1.0) / pitch_u)), max(1, int((depth - 1.2) / pitch_v))
    for i in range(n_u):
        for j in range(n_v):
            u = (i + 0.5) * length / n_u - 0.8 * columns
            v = 0.6 + (j + 0.5) * (depth - 0.6) / n_v - 0.8
            what = generator.random()
            if what < 0.8:
                yield from _table_with_chairs(u, v, u + 1.6 * columns, v + 1.6, generator)
            elif what < 0.9:
                yield u + 0.2, v + 0.4, u + 1.4, v + 0.9
    for u in np.arange(1, int(length / 5)) * length / int(length / 5 + 1):
        yield u, depth - 0.4, u + 1.2, depth


_FURNITURE: dict[Kind, Callable[..., Iterator[Piece]]] = {
    "office": _office,
    "shared": _shared,
    "meeting": _meeting,
    "kitchen": _kitchen,
    "lounge": _lounge,
    "storage": _storage,
    "washroom": _washroom,
    "open": _open,
}
