"""What ways to the goal cost the player of the ball game: Dijkstra's algorithm on a coarse grid, by ball size.

The thesis's player is "the A* algorithm" and follows "the lowest cost" (§4.8.5.1). The cost of every place at
once serves her whatever becomes of her moves; a way near walls costs more than its length, since collisions are
part of her loss.
"""

import numpy as np
from numpy.typing import NDArray

CELL = 5
"""Units a side of the cells on which the player plans."""
CARE, MARGIN = 3.0, 70.0
"""How much more a way along a wall costs her than a free one, and the room within which it does."""


def cost_to_go(
    clearance: NDArray[np.float32], radius: float, goal: tuple[int, int, int, int], care: float = CARE
) -> NDArray[np.float32]:
    """Cost of the cheapest way to the goal for a ball of a radius, on cells of `CELL` units with eight neighbours.

    A unit of way costs 1 where there is room of `MARGIN` around the ball, and up to 1 + `care` where there is
    none.

    Parameters
    ----------
    clearance : (SIDE + 1, SIDE + 1) float32
    radius : float
    goal : (left, top, right, bottom)
    care : float
        At least 0.

    Returns
    -------
    cost : (n, n) float32
        0 in the goal, infinite where the ball does not fit or no way leads.
    """
    from scipy.sparse.csgraph import dijkstra

    room = _cell_clearance(clearance) - radius
    weight = np.asarray(1 + care * np.clip(1 - room / MARGIN, 0, 1), np.float64)
    centre = CELL * np.arange(len(room))
    left, top, right, bottom = goal
    inside = ((centre >= top) & (centre <= bottom))[:, None] & ((centre >= left) & (centre <= right))
    goals = np.flatnonzero(inside & (room > 0))
    if not goals.size:
        return np.full(room.shape, np.inf, np.float32)
    way = dijkstra(_graph(room > 0, weight), directed=False, indices=goals, min_only=True)
    return np.asarray(way, np.float32).reshape(room.shape)


def _graph(fits: NDArray[np.bool_], weight: NDArray[np.float64]):
    """Sparse matrix of the steps between neighbouring cells that fit, each of its length times the mean weight."""
    from scipy.sparse import coo_matrix

    n = len(fits)
    number = np.arange(n * n).reshape(n, n)
    heads, tails, costs = [], [], []
    for dy, dx in ((0, 1), (1, 0), (1, 1), (1, -1)):
        here = (slice(0, n - dy), slice(max(0, -dx), n - max(0, dx)))
        there = (slice(dy, n), slice(max(0, dx), n + min(0, dx)))
        both = fits[here] & fits[there]
        heads.append(number[here][both])
        tails.append(number[there][both])
        costs.append(CELL * np.hypot(dx, dy) * (weight[here] + weight[there])[both] / 2)
    ends = (np.concatenate(heads), np.concatenate(tails))
    return coo_matrix((np.concatenate(costs), ends), (n * n, n * n)).tocsr()


def _cell_clearance(clearance: NDArray[np.float32]) -> NDArray[np.float32]:
    """The largest clearance in each cell: a cell is passable if any of its places is."""
    from scipy.ndimage import maximum_filter

    return np.asarray(maximum_filter(clearance, size=CELL, mode="nearest"), np.float32)[::CELL, ::CELL]
