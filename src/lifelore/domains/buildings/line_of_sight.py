"""Measures straight lines over a floor: whether a robot can drive them, how clear they are, and what they cost.

All lengths are in pixels, points are (row, column) with whole numbers at pixel centres.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.inflation import inflate

TIGHT = 20.0
"""Extra cost of a line that is not as clear as wanted, as a multiple of its length: a larger value makes longer
detours around narrow passages."""
HALF_DIAGONAL = math.sqrt(0.5) + 1e-6
"""No point of a pixel is farther from its centre."""


class Ground(NamedTuple):
    """What a line is compared with.

    state : (rows, columns) int32, state of each pixel, -1 where the robot's centre cannot be
    solid : (rows, columns) bool
    narrow : (rows, columns) bool, pixels in which a line may be too near to a solid one
    price : (n_states, 4) float64, pixels that a move costs in addition to its length; inf where there is no move
    radius : every point of a line is farther from all solid pixel centres
    wanted : clearance below which a line is tight
    """

    state: NDArray[np.int32]
    solid: NDArray[np.bool_]
    narrow: NDArray[np.bool_]
    price: NDArray[np.float64]
    radius: float
    wanted: float


def ground_of(floor: Floor, price: NDArray[np.floating], clearance: float | None = None) -> Ground:
    """The ground of a floor; `price` (n_states, 4) and `clearance` in metres.

    The default clearance is the robot's radius and half a pixel, so that the edges of solid pixels are clear too.
    """
    resolution = floor.occupancy.resolution
    wanted = floor.radius + 0.5 if clearance is None else max(clearance / resolution, floor.radius)
    pixels = np.asarray(price, np.float64) / resolution
    narrow = near_solid(floor, wanted + HALF_DIAGONAL)
    return Ground(floor.state, floor.solid, narrow, pixels, floor.radius, float(wanted))


@lru_cache(maxsize=4)
def near_solid(floor: Floor, reach: float) -> NDArray[np.bool_]:
    """Pixels (rows, columns) whose centre lies within `reach` pixels of a solid one; kept for the next path."""
    return inflate(floor.solid, reach)


@kernel
def line_cost(ground, row, column, last_row, last_column):
    """Cost of the line between two points of the floor, in pixels; inf where the robot cannot drive it.

    The length; `TIGHT` times the length if the line is tight; and the price of every move on the way. A line
    through the corner of pixels needs both pixels beside the corner, and the moves of either.
    """
    down, right = last_row - row, last_column - column
    length = math.hypot(down, right)
    at_row, at_column = math.floor(row + 0.5), math.floor(column + 0.5)
    rows_left = abs(math.floor(last_row + 0.5) - at_row)
    columns_left = abs(math.floor(last_column + 0.5) - at_column)
    one_down, one_right = (1 if down > 0 else -1), (1 if right > 0 else -1)
    south, east = (1 if down > 0 else 0), (2 if right > 0 else 3)
    next_row = (at_row + 0.5 * one_down - row) / down if rows_left else np.inf
    next_column = (at_column + 0.5 * one_right - column) / right if columns_left else np.inf
    price, clearance = 0.0, ground.wanted
    while True:
        if ground.narrow[at_row, at_column]:
            clearance = min(clearance, _clearance(ground, at_row, at_column, row, column, down, right))
            if clearance <= ground.radius * (1 + 1e-9):
                return np.inf
        if not rows_left and not columns_left:
            break
        here = ground.state[at_row, at_column]
        if abs(next_row - next_column) < 1e-9:
            below, beside = ground.state[at_row + one_down, at_column], ground.state[at_row, at_column + one_right]
            there = ground.state[at_row + one_down, at_column + one_right]
            if below < 0 or beside < 0 or there < 0:
                return np.inf
            by_row = _move(ground, here, below, south) + _move(ground, below, there, east)
            by_column = _move(ground, here, beside, east) + _move(ground, beside, there, south)
            price += min(by_row, by_column)
            at_row += one_down
            at_column += one_right
            rows_left -= 1
            columns_left -= 1
            next_row += 1 / abs(down)
            next_column += 1 / abs(right)
        else:
            if next_row < next_column:
                action = south
                at_row += one_down
                rows_left -= 1
                next_row += 1 / abs(down)
            else:
                action = east
                at_column += one_right
                columns_left -= 1
                next_column += 1 / abs(right)
            there = ground.state[at_row, at_column]
            if there < 0:
                return np.inf
            price += _move(ground, here, there, action)
        if rows_left == 0:
            next_row = np.inf
        if columns_left == 0:
            next_column = np.inf
        if price == np.inf:
            return np.inf
    tight = TIGHT * length if clearance < ground.wanted - 1e-9 else 0.0
    return length + tight + price


@kernel
def _move(ground, here, there, action):
    return 0.0 if here == there else ground.price[here, action]


@kernel
def _clearance(ground, at_row, at_column, row, column, down, right):
    """Distance of the line from the solid pixels that can be too near to a pixel, `wanted` if there are none."""
    reach = int(ground.wanted + HALF_DIAGONAL) + 1
    square = down * down + right * right
    nearest = ground.wanted * ground.wanted
    for i in range(max(at_row - reach, 0), min(at_row + reach + 1, ground.solid.shape[0])):
        for j in range(max(at_column - reach, 0), min(at_column + reach + 1, ground.solid.shape[1])):
            if ground.solid[i, j]:
                t = ((i - row) * down + (j - column) * right) / square if square > 0 else 0.0
                t = min(max(t, 0.0), 1.0)
                nearest = min(nearest, (i - row - t * down) ** 2 + (j - column - t * right) ** 2)
    return math.sqrt(nearest)
