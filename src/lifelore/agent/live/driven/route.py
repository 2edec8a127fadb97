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


class RoutePlanner:
    """Plans routes in one building.

    Parameters
    ----------
    world : GridWorld
    """

    def __init__(self, world: GridWorld) -> None:
        self._neighbour = neighbour = world.neighbour.astype(np.int64)
        ends = [neighbour[np.maximum(neighbour[:, first], 0), second] for first, second in _CORNERS]
        self._targets = np.column_stack([neighbour, *ends])

    def route(self, start: int, goal: int, seconds: NDArray[np.float64]) -> Route | None:
        """The route of least seconds; None if no moves lead to the goal.

        Parameters
        ----------
        start, goal : int
            States.
        seconds : (n_states, 4) float
            Seconds of each move, > 0; inf for a move that is not possible.
        """
        steps = self._steps(seconds)
        possible = np.isfinite(steps)
        begin = np.concatenate([[0], possible.sum(axis=1).cumsum()])
        n = len(steps)
        graph = sparse.csr_array((steps[possible], self._targets[possible], begin), shape=(n, n))
        _, before = csgraph.dijkstra(graph, indices=start, return_predecessors=True)
        if start != goal and before[goal] < 0:
            return None
        chain = [goal]
        while chain[-1] != start:
            chain.append(int(before[chain[-1]]))
        return self._moves(chain[::-1], steps, seconds)

    def _steps(self, seconds: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n_states, 8) seconds of the four moves and the four diagonal steps."""
        seconds = np.where(self._neighbour < 0, np.inf, seconds)
        after = seconds[np.maximum(self._neighbour, 0)]
        corners = []
        for first, second in _CORNERS:
            ways = seconds[:, first] + after[:, first, second], seconds[:, second] + after[:, second, first]
            free = np.isfinite(ways[0]) & np.isfinite(ways[1])
            corners.append(np.where(free, DIAGONAL * np.minimum(*ways), np.inf))
        return np.column_stack([seconds, *corners])

    def _moves(self, chain: list[int], steps: NDArray[np.float64], seconds: NDArray[np.float64]) -> Route:
        states, lengths = chain[:1], []
        for place, following in pairwise(chain):
            step = int(np.where(self._targets[place] == following, steps[place], np.inf).argmin())
            if step >= 4:
                first = self._cheaper_first(place, _CORNERS[step - 4], seconds)
                states.append(int(self._neighbour[place, first]))
            states.append(following)
            lengths += [1.0] if step < 4 else [DIAGONAL, DIAGONAL]
        return Route(np.array(states, np.int64), np.array(lengths))

    def _cheaper_first(self, place: int, corner: tuple[int, int], seconds: NDArray[np.float64]) -> int:
        """The first of a corner's two moves in the order that takes less time."""
        orders = (corner, corner[::-1])
        return min(
            orders, key=lambda two: seconds[place, two[0]] + seconds[self._neighbour[place, two[0]], two[1]]
        )[0]
