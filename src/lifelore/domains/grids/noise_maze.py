"""Noise mazes: a random share of a walled square's cells are obstacles, the free space stays connected.

At the thesis's 50–80 % independently drawn obstacles would leave the free cells in crumbs, so cells are
walled up one at a time, in random order, passing over any whose loss would part the rest.

Thesis: §3.4.1, Figures 3.1 and 3.4.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.errors import InputError
from lifelore.domains.grids.grid_world import GridWorld

MAX_SIZE = 101
DENSITY_RANGE = (0.5, 0.8)
"""Share of obstacles in the thesis's experiment; the density is drawn from it where none is given."""


def noise_maze(
    generator: np.random.Generator,
    size: int = 23,
    density: float | None = None,
    obstacles: int | None = None,
    discount: float = 0.95,
    goal_reward: float = 100.0,
    wall_reward: float = -10.0,
) -> GridWorld:
    """A random maze of `size` × `size` cells, the wall around counted; connected.

    Parameters
    ----------
    generator : numpy.random.Generator
    size : int
        4 to `MAX_SIZE`; the cells inside the wall are (size - 2)².
    density : float, optional
        Share of the inside cells that are obstacles, in [0, 1); default: drawn from `DENSITY_RANGE`.
    obstacles : int, optional
        Their exact number instead, e.g. 6 at size 7 for the mazes of Figure 3.1.
    discount, goal_reward, wall_reward : float
        As in `GridWorld`; the defaults are the thesis's.

    Raises
    ------
    InputError
        `size`, `density` or `obstacles` breaks its rule, both of the last two are given, or fewer than two
        free cells would remain.

    Examples
    --------
    >>> noise_maze(np.random.default_rng(0), size=7, obstacles=6).n_states
    19
    """
    if not 4 <= size <= MAX_SIZE:
        raise InputError(f"size of a noise maze must lie in [4, {MAX_SIZE}], got {size}")
    inside = (size - 2) ** 2
    count = _obstacle_count(generator, inside, density, obstacles)
    if not 0 <= count <= inside - 2:
        raise InputError(f"obstacles must lie in [0, {inside - 2}] at size {size}, got {count}")
    free = np.zeros((size, size), dtype=bool)
    free[1:-1, 1:-1] = True
    _wall_up(free, count, generator)
    return GridWorld.from_free("noise", free, discount=discount, goal_reward=goal_reward, wall_reward=wall_reward)


def _obstacle_count(
    generator: np.random.Generator, inside: int, density: float | None, obstacles: int | None
) -> int:
    if density is not None and obstacles is not None:
        raise InputError(f"give density or obstacles, not both, got {density} and {obstacles}")
    if obstacles is not None:
        return int(obstacles)
    if density is None:
        density = float(generator.uniform(*DENSITY_RANGE))
    if not 0 <= density < 1:
        raise InputError(f"density must lie in [0, 1), got {density}")
    return round(density * inside)


def _wall_up(free: NDArray[np.bool_], count: int, generator: np.random.Generator) -> None:
    """Turn `count` free cells into obstacles without parting the rest; in place.

    Every connected set has a cell it can spare, so passes end only when enough are walled up.
    """
    cells = free.reshape(-1)
    while count:
        count = _wall_up_some(cells, generator.permutation(np.flatnonzero(cells)), count, free.shape[1])


@kernel
def _wall_up_some(free, order, count, width):
    """Wall up at most `count` cells, in `order`, that can be spared; returns how many are left to do.

    free : (n_cells,) bool, row by row; its outermost cells are walls
    """
    stack, seen = np.empty(free.size, np.int64), np.zeros(free.size, np.int64)
    for number in range(order.size):
        if count == 0:
            break
        if _can_spare(free, order[number], width, stack, seen, number + 1):
            free[order[number]] = False
            count -= 1
    return count


@kernel
def _can_spare(free, cell, width, stack, seen, mark):
    """Whether the free neighbours of `cell` stay connected without it.

    stack, seen : (n_cells,) int64, work space; no number of `seen` is `mark`, which is above 0
    """
    ring = (-width, 1 - width, 1, width + 1, width, width - 1, -1, -width - 1)  # N, NE, E … clockwise
    sides, joins, first = 0, 0, 0
    for i in range(0, 8, 2):
        if free[cell + ring[i]]:
            sides += 1
            first = cell + ring[i]
            # Side by side round the ring, two free sides meet through a free corner.
            if free[cell + ring[i + 1]] and free[cell + ring[(i + 2) % 8]]:
                joins += 1
    if sides - joins <= 1:
        return sides > 0
    # Walk from one side, never into the cell, until all sides are met.
    seen[cell], seen[first], stack[0] = mark, mark, first
    n, left = 1, sides - 1
    while n and left:
        n -= 1
        place = stack[n]
        for i in range(0, 8, 2):
            beside = place + ring[i]
            if free[beside] and seen[beside] != mark:
                seen[beside] = mark
                stack[n] = beside
                n += 1
                apart = abs(beside - cell)
                left -= apart == 1 or apart == width
    return left == 0
