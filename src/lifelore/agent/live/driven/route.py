"""Plans the cheapest route between two places of a building, from the seconds of each move.

A diagonal step consists of two moves around a corner whose both sides are free. Its length is √½ of theirs.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.domains.grids.grid_world import GridWorld

DIAGONAL = 0.5**0.5
"""Length of a diagonal step as a share of the length of its two moves."""
_CORNERS = ((0, 2), (0, 3), (1, 2), (1, 3))
"""North-east, north-west, south-east and south-west as two moves, in the order of `MOVES`."""


@dataclass(frozen=True, eq=False)
class Route:
    """Moves from a start to a goal.

    states : (n + 1,) int, from the start to the goal
    lengths : (n,) float, length of each move in cells: 1, or `DIAGONAL`
    """

    states: NDArray[np.int64]
    lengths: NDArray[np.float64]


def cheapest_route(world: GridWorld, start: int, goal: int, seconds: NDArray[np.float64]) -> Route | None:
    """The route of least seconds; None if no moves lead to the goal.

    Parameters
    ----------
    world : GridWorld
    start, goal : int
        States.
    seconds : (n_states, 4) float
        Seconds of each move, > 0; inf for a move that is not possible.
    """
    neighbour = world.neighbour.astype(np.int64)
    ends = [neighbour[np.maximum(neighbour[:, first], 0), second] for first, second in _CORNERS]
    targets, steps = np.column_stack([neighbour, *ends]), _steps(neighbour, seconds)
    possible = np.isfinite(steps)
    begin = np.concatenate([[0], possible.sum(axis=1).cumsum()])
    graph = sparse.csr_array((steps[possible], targets[possible], begin), shape=(len(steps),) * 2)
    _, before = csgraph.dijkstra(graph, indices=start, return_predecessors=True)
    chain = chain_to(goal, start, before)
    states, lengths = chain[:1], []
    for place, following in pairwise(chain):
        step = int(np.where(targets[place] == following, steps[place], np.inf).argmin())
        if step >= 4:
            orders = _CORNERS[step - 4], _CORNERS[step - 4][::-1]
            first, _ = min(
                orders, key=lambda two: seconds[place, two[0]] + seconds[neighbour[place, two[0]], two[1]]
            )
            states.append(int(neighbour[place, first]))
        states.append(following)
        lengths += [1.0] if step < 4 else [DIAGONAL, DIAGONAL]
    return Route(np.array(states, np.int64), np.array(lengths)) if chain else None


def chain_to(goal: int, start: int, before: NDArray[np.int32]) -> list[int]:
    """The nodes of a shortest path, `start` first; empty if none leads to `goal`.

    `before` (n,) is the node before each node, negative where there is none, as SciPy's `dijkstra` returns it.
    """
    chain = [goal]
    while chain[-1] != start:
        if before[chain[-1]] < 0:
            return []
        chain.append(int(before[chain[-1]]))
    return chain[::-1]


def moves_along(world: GridWorld, states: NDArray[np.int64]) -> NDArray[np.int64]:
    """The action (n,) of each move along a way of (n + 1,) states."""
    return (world.neighbour[states[:-1]] == states[1:, None]).argmax(axis=1)


def _steps(neighbour: NDArray[np.int64], seconds: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n_states, 8) seconds of the four moves and the four diagonal steps."""
    seconds = np.where(neighbour < 0, np.inf, seconds)
    after = seconds[np.maximum(neighbour, 0)]
    corners = []
    for first, second in _CORNERS:
        ways = seconds[:, first] + after[:, first, second], seconds[:, second] + after[:, second, first]
        free = np.isfinite(ways[0]) & np.isfinite(ways[1])
        corners.append(np.where(free, DIAGONAL * np.minimum(*ways), np.inf))
    return np.column_stack([seconds, *corners])
