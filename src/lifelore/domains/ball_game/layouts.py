"""Layouts of the ball game: obstacles, a start and a goal in a square field of 1000 × 1000 units.

The thesis draws one (Figure 4.14) and gives no measures. A loss can turn from "fast is best" to "slow is best"
only where the room that a ball has, the width of a corridor less its diameter, crosses the range of speeds; so
corridors of several widths stand here beside fields that have no corridors. Thesis: §4.8.5.1.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream

SIDE = 1000
"""Units a side; the border is a wall."""
_BLOBS, _CORNERS = 9, 7


@dataclass(frozen=True)
class Layout:
    """Obstacles, start and goal of one layout.

    Parameters
    ----------
    name : str
    polygons : tuple of (n, 2) tuples
        Corners (x, y) of the obstacles, y downwards.
    start : (x, y) int
        Where the ball's centre starts.
    goal : (left, top, right, bottom) int
        Rectangle that the ball's centre must enter, its edges included.
    """

    name: str
    polygons: tuple[tuple[tuple[float, float], ...], ...]
    start: tuple[int, int]
    goal: tuple[int, int, int, int]


def s_maze(width: int) -> Layout:
    """Three corridors of `width` units, one above the other, joined at alternate ends.

    Raises
    ------
    InputError
        A width outside [20, 300]: the walls between would be thinner than the longest move.
    """
    if not 20 <= width <= 300:
        raise InputError(f"width must lie in [20, 300], got {width}")
    top, bottom = (SIDE - width) / 2, (SIDE + width) / 2
    walls = (
        _rectangle(0, width, SIDE - width, top),
        _rectangle(width, bottom, SIDE, SIDE - width),
    )
    start = (width // 2, width // 2)
    goal = (SIDE - width, SIDE - width, SIDE, SIDE)
    return Layout(f"s-maze {width}", walls, start, goal)


def open_field() -> Layout:
    """No obstacle between start and goal."""
    return Layout("open field", (), (100, 100), (840, 840, SIDE, SIDE))


def blobs(seed: int = 0) -> Layout:
    """Nine polygons of seven corners, each somewhere in its own third of a third of the field."""
    generator = stream(seed, "ball game", "blobs")
    found = []
    for cell in range(_BLOBS):
        middle = 200 + 300 * np.array([cell % 3, cell // 3]) + generator.uniform(-40, 40, 2)
        turn = np.sort(generator.uniform(0, 2 * np.pi, _CORNERS))
        reach = generator.uniform(45, 80, _CORNERS)
        corners = middle + reach[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
        found.append(tuple((float(x), float(y)) for x, y in corners))
    return Layout("blobs" if seed == 0 else f"blobs {seed}", tuple(found), (70, 70), (860, 860, SIDE, SIDE))


def _rectangle(left: float, top: float, right: float, bottom: float) -> tuple[tuple[float, float], ...]:
    return ((left, top), (right, top), (right, bottom), (left, bottom))


def layout_names() -> tuple[str, ...]:
    """Layouts that go by name; any ``s-maze W`` and ``blobs SEED`` does too."""
    return ("s-maze 160", "s-maze 110", "s-maze 200", "open field", "blobs")


@cache
def layout_of(name: str) -> Layout:
    """The layout of a name, such as ``"s-maze 160"``.

    Raises
    ------
    NotFoundError
        No such layout.
    """
    kind, _, number = name.rpartition(" ")
    if kind == "s-maze" and number.isdecimal():
        return s_maze(int(number))
    if kind == "blobs" and number.isdecimal():
        return blobs(int(number))
    if name in ("open field", "blobs"):
        return open_field() if name == "open field" else blobs()
    raise NotFoundError(f"unknown layout '{name}'; there are {', '.join(layout_names())}")


def obstacle_points(layout: Layout) -> NDArray[np.bool_]:
    """Which whole-numbered places lie in an obstacle or on the border, (SIDE + 1, SIDE + 1) bool, [y, x]."""
    solid = np.zeros((SIDE + 1, SIDE + 1), bool)
    solid[[0, -1]] = solid[:, [0, -1]] = True
    for polygon in layout.polygons:
        corners = np.asarray(polygon, float)
        (left, top), (right, bottom) = np.floor(corners.min(axis=0)), np.ceil(corners.max(axis=0))
        x, y = np.arange(max(left, 0), min(right, SIDE) + 1), np.arange(max(top, 0), min(bottom, SIDE) + 1)
        inside = _inside(corners, x[None, :], y[:, None])
        solid[int(y[0]) : int(y[-1]) + 1, int(x[0]) : int(x[-1]) + 1] |= inside
    return solid


def _inside(corners: NDArray[np.float64], x: NDArray, y: NDArray) -> NDArray[np.bool_]:
    """Whether places lie within a polygon: a ray to the right crosses its outline an odd number of times.

    Left and upper edges belong to it, right and lower ones do not.
    """
    odd = np.zeros(np.broadcast_shapes(x.shape, y.shape), bool)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if y0 != y1:
            odd ^= ((y0 <= y) != (y1 <= y)) & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return odd
