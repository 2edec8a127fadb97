"""Noise mazes: a random share of a walled square's cells are obstacles, the free space stays connected.

At the thesis's 50–80 % independently drawn obstacles would leave the free cells in crumbs, so cells are
walled up one at a time, in random order, passing over any whose loss would part the rest.

Thesis: §3.4.1, Figures 3.1 and 3.4.
"""

import numpy as np
from numpy.typing import NDArray

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
    width = free.shape[1]
    cells = bytearray(free.tobytes())
    while count:
        for cell in generator.permutation(np.flatnonzero(np.frombuffer(bytes(cells), bool))).tolist():
            if count and _can_spare(cells, cell, width):
                cells[cell] = 0
                count -= 1
    free[:] = np.frombuffer(bytes(cells), bool).reshape(free.shape)


def _can_spare(free: bytearray, cell: int, width: int) -> bool:
    """Whether the free neighbours of `cell` stay connected without it."""
    ring = (-width, 1 - width, 1, width + 1, width, width - 1, -1, -width - 1)  # N, NE, E … clockwise
    around = [free[cell + step] for step in ring]
    sides = sum(around[::2])
    # Side by side round the ring, two free sides meet through a free corner: no search is needed.
    joins = sum(around[i] and around[i + 1] and around[(i + 2) % 8] for i in (0, 2, 4, 6))
    if sides - joins <= 1:
        return sides > 0
    return _meet_without(free, cell, [cell + step for step in ring[::2] if free[cell + step]], width)


def _meet_without(free: bytearray, cell: int, sides: list[int], width: int) -> bool:
    """Whether walks that never enter `cell` join all of `sides`.

    The walks grow from all sides in turn, so that a dead end costs a search of its own size only.
    """
    walks = [({side}, [side]) for side in sides]
    while len(walks) > 1:
        seen, frontier = walks.pop(0)
        frontier = _one_step_on(free, cell, seen, frontier, width)
        met = next((walk for walk in walks if not walk[0].isdisjoint(frontier)), None)
        if met is not None:
            walks.remove(met)
            walks.append((seen | met[0], frontier + met[1]))
        elif not frontier:
            return False
        else:
            walks.append((seen, frontier))
    return True


def _one_step_on(free: bytearray, cell: int, seen: set[int], frontier: list[int], width: int) -> list[int]:
    """The free cells beside `frontier` that are not yet in `seen`, which they join."""
    reached = []
    for place in frontier:
        for step in (-width, width, 1, -1):
            beside = place + step
            if free[beside] and beside != cell and beside not in seen:
                seen.add(beside)
                reached.append(beside)
    return reached
