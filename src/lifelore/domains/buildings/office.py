"""An invented office floor as an occupancy map: the default building where the user has no map.

Seeds give different buildings, not one building redrawn: the corridors may form a spine, a ladder or a comb
(a floor in the shape of an L, T or U), and rooms, doors and furniture are drawn anew.
"""

import math

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED, UNKNOWN, OccupancyMap
from lifelore.domains.buildings.office_furniture import furnish
from lifelore.domains.buildings.office_plan import WALL, OfficePlan, Rect, Room, plan_office

RESOLUTION = 0.05
"""Metres a pixel; lengths in the plan are whole multiples."""
_MARGIN = 1.0
_OUTER_WALL = 0.2
_SMALLEST, _LARGEST = 12.0, 150.0


def office_map(
    seed: int = 0, width_m: float = 32.0, height_m: float = 22.0, furniture: int | None = None
) -> OccupancyMap:
    """An invented office floor, connected, with corridors, rooms, doors of at least 0.9 m and furniture.

    Parameters
    ----------
    seed : int
        The same seed gives the same building.
    width_m, height_m : float
        Space the floor may take, in metres, 12 to 150 each; the default gives some 1,400–2,400 states
        at cells of 0.5 m.
    furniture : int, optional
        Another seed for the furniture alone, for a second floor with the same walls.

    Raises
    ------
    InputError
        `width_m` or `height_m` breaks its rule.

    Examples
    --------
    >>> office_map(seed=1, width_m=16.0, height_m=12.0).state.shape
    (280, 360)
    """
    for label, length in (("width_m", width_m), ("height_m", height_m)):
        if not (math.isfinite(length) and _SMALLEST <= length <= _LARGEST):
            raise InputError(f"{label} must lie in [{_SMALLEST:g}, {_LARGEST:g}] metres, got {length}")
    generator = stream(seed, "office")
    plan = plan_office(generator, round(width_m, 1), round(height_m, 1))
    state = _draw(plan, round(width_m, 1), round(height_m, 1), generator)
    if furniture is not None:
        state = _draw(plan, round(width_m, 1), round(height_m, 1), stream(furniture, "office furniture"))
    flips = generator.integers(2, size=2) * 2 - 1
    state = np.ascontiguousarray(state[:: flips[0], :: flips[1]])
    return OccupancyMap(state, RESOLUTION, source=f"office (seed {seed})")


def _draw(plan: OfficePlan, width: float, height: float, generator: np.random.Generator) -> NDArray[np.uint8]:
    shape = tuple(round((length + 2 * _MARGIN) / RESOLUTION) for length in (height, width))
    state = np.full(shape, UNKNOWN, np.uint8)
    tiles = [*plan.corridors, *(room.rect for room in plan.rooms)]
    for tile in tiles:
        _paint(state, _grown(tile, _OUTER_WALL), OCCUPIED)
    for corridor in plan.corridors:
        _paint(state, corridor, FREE)
    for room in plan.rooms:
        _paint(state, room.rect, OCCUPIED)
        _paint(state, _grown(room.rect, -WALL), UNKNOWN if room.kind == "shaft" else FREE)
        for u0, u1 in room.doors:
            _paint(state, room.rect.part(room.side, u0, 0, u1, WALL), FREE)
    for passage in plan.passages:
        _paint(state, passage, FREE)
    for room in plan.rooms:
        _furnish(state, room, plan.passages, generator)
    for corridor in plan.corridors:
        _paint_plants(state, corridor, plan, generator)
    return state


def _furnish(
    state: NDArray[np.uint8], room: Room, passages: tuple[Rect, ...], generator: np.random.Generator
) -> None:
    inner = _grown(room.rect, -WALL)
    length, depth = inner.seen_from(room.side)
    doors = [(u0 - WALL, u1 - WALL) for u0, u1 in room.doors]
    for piece in furnish(room.kind, length, depth, doors, generator):
        rect = inner.part(room.side, *piece)
        if not any(_overlap(rect, _grown(passage, 0.7)) for passage in passages):
            _paint(state, rect, OCCUPIED)


def _paint_plants(
    state: NDArray[np.uint8], corridor: Rect, plan: OfficePlan, generator: np.random.Generator
) -> None:
    """A plant, a printer or a bench against a corridor's wall here and there, where no door is near."""
    side = "top" if corridor.x1 - corridor.x0 >= corridor.y1 - corridor.y0 else "left"
    length, depth = corridor.seen_from(side)
    doors = [room.rect.part(room.side, u0, 0, u1, WALL) for room in plan.rooms for u0, u1 in room.doors]
    others = [other for other in plan.corridors if other is not corridor]
    for _ in range(int(length / 7)):
        u, long = float(generator.uniform(0.5, length - 1.5)), float(generator.choice([0.4, 0.7, 1.2]))
        v = 0.0 if generator.random() < 0.5 else depth - 0.4
        rect = corridor.part(side, u, v, u + long, v + 0.4)
        if not any(_overlap(_grown(rect, 0.8), place) for place in [*doors, *others]):
            _paint(state, rect, OCCUPIED)


def _paint(state: NDArray[np.uint8], rect: Rect, value: int) -> None:
    x0, y0, x1, y1 = (round((length + _MARGIN) / RESOLUTION) for length in rect)
    state[y0:y1, x0:x1] = value


def _grown(rect: Rect, by: float) -> Rect:
    return Rect(rect.x0 - by, rect.y0 - by, rect.x1 + by, rect.y1 + by)


def _overlap(a: Rect, b: Rect) -> bool:
    return a.x0 < b.x1 and b.x0 < a.x1 and a.y0 < b.y1 and b.y0 < a.y1
