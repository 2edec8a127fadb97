"""Places of a building where many ways pass, and what is left of it where passages are blocked."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.domains.grids.grid_world import GridWorld

WAYS = 40
"""Number of random ways that are followed."""


def on_shortest_ways(world: GridWorld, rng: np.random.Generator) -> NDArray[np.float64]:
    """How often shortest ways between random places pass each cell, as probabilities above 0."""
    counts = np.full(world.n_states, 0.01)
    starts = rng.integers(world.n_states, size=WAYS)
    before = csgraph.shortest_path(
        move_graph(world.neighbour), indices=starts, unweighted=True, return_predecessors=True
    )[1]
    for row, place in zip(before, rng.integers(world.n_states, size=WAYS), strict=True):
        while place >= 0:
            counts[place] += 1
            place = row[place]
    return counts / counts.sum()


def blocked_passages(
    world: GridWorld, rng: np.random.Generator, busy: NDArray[np.float64], n: int, radius: int
) -> NDArray[np.bool_]:
    """The cells of up to `n` passages, drawn by `busy`, that can all be blocked at once: (passages, n_states).

    A passage may be blocked where the rest of the building stays one, and at least nine in ten of its cells.
    """
    opened, found = np.ones(world.n_states, np.bool_), []
    for middle in rng.choice(world.n_states, size=min(200, world.n_states), replace=False, p=busy):
        if len(found) == n:
            break
        trial = opened & ~around(world, int(middle), radius)
        left = largest_part(without(world.neighbour, trial), trial)
        if left.sum() >= trial.sum() - 2 and left.mean() >= 0.9:
            found.append(opened & ~left)
            opened = left
    return np.array(found, np.bool_).reshape(-1, world.n_states)


def move_graph(neighbour: NDArray[np.int32], cost: NDArray[np.float64] | None = None) -> sparse.csr_matrix:
    """Moves as a graph; `cost` of entering each cell, else 1."""
    n = len(neighbour)
    start, move = np.nonzero(neighbour >= 0)
    end = neighbour[start, move]
    weights = np.ones(len(end)) if cost is None else cost[end]
    return sparse.csr_matrix((weights, (start, end)), shape=(n, n))


def around(world: GridWorld, middle: int, radius: int) -> NDArray[np.bool_]:
    """Cells (n_states,) bool whose larger coordinate difference from `middle` is at most `radius`."""
    return np.abs(world.cells - world.cells[middle]).max(axis=1) <= radius


def without(neighbour: NDArray[np.int32], opened: NDArray[np.bool_]) -> NDArray[np.int32]:
    """Moves between open cells alone."""
    passes = (neighbour >= 0) & opened[:, None] & opened[neighbour]
    return np.where(passes, neighbour, -1).astype(np.int32)


def largest_part(neighbour: NDArray[np.int32], opened: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The open cells (n_states,) of the largest connected part."""
    part = csgraph.connected_components(move_graph(neighbour), directed=False)[1]
    return opened & (part == np.bincount(part[opened]).argmax())
