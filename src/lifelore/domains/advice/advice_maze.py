"""The advice maze: a large building of winding corridors with some loops, and eight places people go to.

A tree of corridors is carved depth first, so that they wind, branch and end; then a share of the walls between
two corridors is opened, which makes the loops. The thesis draws one such maze (Figure 3.20) and does not say how
it was made.

Thesis: §3.7.2.1.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.mdp import Task
from lifelore.domains.grids.grid_world import MOVES, GridWorld

MAX_SIZE = 201
N_GOALS = 8
LOOPS = 0.1


def advice_maze(
    generator: np.random.Generator,
    size: int = 30,
    loops: float = LOOPS,
    n_goals: int = N_GOALS,
    discount: float = 0.95,
    goal_reward: float = 1000.0,
    wall_reward: float = 0.0,
) -> GridWorld:
    """A random maze of `size` × `size` cells, the wall around counted; connected.

    Parameters
    ----------
    generator : numpy.random.Generator
    size : int
        6 to `MAX_SIZE`.
    loops : float
        Share, in [0, 1], of the places where a wall parts two corridors that are opened; 0 is a tree.
    n_goals : int
        At least 1; for each a fair coin says corner or corridor's end (the other where there is none left).
    discount, goal_reward, wall_reward : float
        As in `GridWorld`; the rewards are the thesis's.

    Returns
    -------
    GridWorld
        Its goals stand in ``about["goals"]``, as states; see `maze_goals`.

    Raises
    ------
    InputError
        An argument breaks its rule, or the maze has too few corners and ends for the goals.

    Examples
    --------
    >>> world = advice_maze(np.random.default_rng(0))
    >>> world.shape, len(maze_goals(world))
    ((30, 30), 8)
    """
    if not 6 <= size <= MAX_SIZE:
        raise InputError(f"size of an advice maze must lie in [6, {MAX_SIZE}], got {size}")
    if not 0 <= loops <= 1:
        raise InputError(f"loops must be a share in [0, 1], got {loops}")
    free = _corridors(size, loops, generator)
    world = GridWorld.from_free(
        "advice", free, discount=discount, goal_reward=goal_reward, wall_reward=wall_reward
    )
    return replace(world, about={"goals": _place_goals(world, n_goals, generator)})


def maze_goals(world: GridWorld) -> NDArray[np.int32]:
    """The states to which people of this maze go, (n_goals,).

    Examples
    --------
    >>> maze_goals(advice_maze(np.random.default_rng(3))).size
    8
    """
    return np.asarray(world.about["goals"], np.int32)


def errand(world: GridWorld, goal: int, starts: NDArray[np.int32] | None = None) -> Task:
    """The task of reaching `goal`, one of `maze_goals`; the other goals are cells like any other.

    `starts` (n,) int are by default all states that are no goal.
    """
    if starts is None:
        starts = np.setdiff1d(np.arange(world.n_states, dtype=np.int32), maze_goals(world))
    return world.task(goal, starts)


def _corridors(size: int, loops: float, generator: np.random.Generator) -> NDArray[np.bool_]:
    """The free cells: a tree of corridors and the loops opened in it; one cell wide, walls between them."""
    n = (size - 1) // 2
    free = np.zeros((2 * n + 1, 2 * n + 1), dtype=bool)
    free[1::2, 1::2] = True
    for between in _tree(n, generator):
        free[between] = True
    rows, columns = np.indices(free.shape)
    walls = np.argwhere(~free & ((rows + columns) % 2 == 1) & _inside(free.shape))
    chosen = generator.permutation(walls)[: round(loops * len(walls))]
    free[tuple(chosen.T)] = True
    if size % 2 == 1:
        return free
    # Corridors and walls lie on every second line: of an even size, one line of walls is two cells thick.
    row, column = 2 * generator.integers(1, n, 2)
    free = np.insert(free, row, free[row], axis=0)
    return np.insert(free, column, free[:, column], axis=1)


def _inside(shape: tuple[int, int]) -> NDArray[np.bool_]:
    inside = np.zeros(shape, dtype=bool)
    inside[1:-1, 1:-1] = True
    return inside


def _tree(n: int, generator: np.random.Generator) -> Iterator[tuple[int, int]]:
    """Cells to open so that n × n crossings hang together without loops, found depth first."""
    seen = np.zeros((n + 2, n + 2), dtype=bool)
    seen[[0, -1]] = seen[:, [0, -1]] = True
    row, column = (generator.integers(1, n + 1, 2)).tolist()
    seen[row, column] = True
    path = [(row, column)]
    while path:
        row, column = path[-1]
        ways = [(dr, dc) for dr, dc in MOVES.tolist() if not seen[row + dr, column + dc]]
        if not ways:
            path.pop()
            continue
        dr, dc = ways[generator.integers(len(ways))]
        yield 2 * row - 1 + dr, 2 * column - 1 + dc
        seen[row + dr, column + dc] = True
        path.append((row + dr, column + dc))


def _place_goals(world: GridWorld, n_goals: int, generator: np.random.Generator) -> tuple[int, ...]:
    open_moves = world.neighbour >= 0
    ways = open_moves.sum(axis=1)
    bends = (ways == 2) & (open_moves[:, :2].sum(axis=1) == 1)
    ends, corners = (list(generator.permutation(np.flatnonzero(kind))) for kind in (ways == 1, bends))
    if not 1 <= n_goals <= len(ends) + len(corners):
        raise InputError(
            f"n_goals must lie in [1, {len(ends) + len(corners)}], as many as this maze has corners and ends, "
            f"got {n_goals}"
        )
    goals = []
    for _ in range(n_goals):
        wanted, other = (ends, corners) if generator.random() < 0.5 else (corners, ends)
        goals.append(int((wanted or other).pop()))
    return tuple(goals)
