"""Computes short paths in metres that stay clear of obstacles by the robot's radius.

A path from cell to cell is not a path for a robot: the line between the centres of two cells may cross a wall.
Here the search runs over the pixels of the cells' own pieces of free space (Dijkstra, 8 neighbours), and the
result is shortened where the straight line is clear.
"""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.line_of_sight import LineOfSight, move_codes

_NEIGHBOURS = [(r, c) for r in (-1, 0, 1) for c in (-1, 0, 1) if (r, c) != (0, 0)]
_NARROW = 2.0
"""Extra cost of a pixel that is only just clear, as a share of its length; pixels with `comfort` cost nothing."""


def clear_path(
    floor: Floor,
    moves: NDArray[np.integer],
    start: tuple[float, float],
    goal: tuple[float, float],
    shortcuts: NDArray[np.integer] | None = None,
) -> NDArray[np.float64] | None:
    """A path of straight segments from `start` to `goal`, (n, 2) in metres of the map's frame.

    Parameters
    ----------
    floor : Floor
    moves : (n, 2) int
        Pairs of states (from, to). The search changes from the piece of one state to that of another only by these
        moves.
    start, goal : (x, y)
        Points in metres, free places of the floor (`Floor.state_at`).
    shortcuts : (m, 2) int, optional
        Moves by which a straight line may change from piece to piece; default: wherever pieces touch.

    Returns
    -------
    (n, 2) float, or None
        From `start` to `goal`; None if `moves` do not join them on this floor. Every segment lies in pixels of the
        floor, and farther than the robot's radius from the centre of every solid pixel. A shortcut comes no nearer
        to an obstacle than the part that it replaces, or than one pixel more than the radius.
    """
    ends = floor.pixels([start, goal])
    first, last = (tuple(np.rint(end).astype(int)) for end in ends)
    chain = _pixel_path(floor, moves, first, last)
    if chain is None:
        return None
    sight = LineOfSight(floor, shortcuts)
    # Between two pixel centres a step is as clear as its ends; only the first and last lines must be measured.
    at_pixel = np.minimum(floor.distance[tuple(chain.T)], sight.comfort)
    to_chain = [[sight.clearance(end, chain[k])] for end, k in zip(ends, (0, -1), strict=True)]
    clearances = np.concatenate([to_chain[0], np.minimum(at_pixel[:-1], at_pixel[1:]), to_chain[1]])
    points = np.vstack([ends[:1], chain.astype(float), ends[1:]])
    return floor.metres(_shortened(points, clearances, sight))


def _pixel_path(
    floor: Floor, moves: NDArray[np.integer], first: tuple[int, ...], last: tuple[int, ...]
) -> NDArray[np.int64] | None:
    """The cheapest chain of neighbouring pixels over `moves`, (n, 2); None if there is none."""
    ends = [floor.state[first], floor.state[last]]
    pixel = floor.pixels_of(np.concatenate([np.ravel(moves), ends]))
    graph = _pixel_graph(floor, pixel, moves)
    columns = floor.state.shape[1]
    source, sink = np.searchsorted(pixel, [first[0] * columns + first[1], last[0] * columns + last[1]])
    _, before = csgraph.dijkstra(graph, indices=source, return_predecessors=True)
    chain = [sink]
    while chain[-1] != source:
        if before[chain[-1]] < 0:
            return None
        chain.append(before[chain[-1]])
    return np.column_stack(np.unravel_index(pixel[chain[::-1]], floor.state.shape))


def _pixel_graph(floor: Floor, pixel: NDArray[np.int64], moves: NDArray[np.integer]) -> sparse.csr_array:
    """Steps between neighbouring pixels of one state, or of two states that a move joins, with their costs."""
    row, column = np.unravel_index(pixel, floor.state.shape)
    top, left = row.min() - 1, column.min() - 1
    number = np.full((row.max() - top + 2, column.max() - left + 2), -1, np.int64)
    number[row - top, column - left] = np.arange(len(pixel))
    state = floor.state.ravel()[pixel].astype(np.int64)
    known = move_codes(floor, moves)
    comfort = floor.radius + 1
    cost = 1 + _NARROW * np.clip(comfort - floor.distance.ravel()[pixel], 0, 1)
    tails, heads, costs = [], [], []
    for d_row, d_column in _NEIGHBOURS:
        at = row - top, column - left
        head = number[at[0] + d_row, at[1] + d_column]
        # Both pixels beside a diagonal must be there: the step then stays clear of obstacles at the corner.
        beside = (number[at[0] + d_row, at[1]] >= 0) & (number[at[0], at[1] + d_column] >= 0)
        tail = np.flatnonzero((head >= 0) & beside)
        head = head[tail]
        joined = (state[tail] == state[head]) | np.isin(state[tail] * floor.n_states + state[head], known)
        tail, head = tail[joined], head[joined]
        tails.append(tail)
        heads.append(head)
        costs.append(np.hypot(d_row, d_column) * (cost[tail] + cost[head]) / 2)
    where = np.concatenate(tails), np.concatenate(heads)
    return sparse.csr_array((np.concatenate(costs), where), shape=(len(pixel),) * 2)


def _shortened(
    points: NDArray[np.float64], clearances: NDArray[np.float64], sight: LineOfSight
) -> NDArray[np.float64]:
    """A subset of the points of a path, first and last included, with a clear line between neighbours."""
    kept = _corners(points, clearances, sight)
    chosen, here = [0], 0
    while here < len(kept) - 1:
        ahead = range(len(kept) - 1, here, -1)
        here = next(k for k in ahead if k == here + 1 or _may_skip(points, clearances, kept[here], kept[k], sight))
        chosen.append(here)
    path = points[[kept[k] for k in chosen]]
    return path[np.r_[True, (np.diff(path, axis=0) != 0).any(axis=1)]]


def _corners(points: NDArray[np.float64], clearances: NDArray[np.float64], sight: LineOfSight) -> list[int]:
    """Split the path at the point farthest from the straight line until all lines are clear; indices of points."""
    kept, parts = [0], [(0, len(points) - 1)]
    while parts:
        i, j = parts.pop()
        if j <= i + 1 or _may_skip(points, clearances, i, j, sight):
            kept.append(j)
            continue
        middle = i + 1 + int(_off_line(points[i + 1 : j], points[i], points[j]).argmax())
        parts += [(middle, j), (i, middle)]
    return kept


def _off_line(points: NDArray[np.float64], a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    along = b - a
    if not along.any():
        return np.hypot(*(points - a).T)
    return np.abs((points - a) @ (-along[1], along[0]))


def _may_skip(
    points: NDArray[np.float64], clearances: NDArray[np.float64], i: int, j: int, sight: LineOfSight
) -> bool:
    return sight.clearance(points[i], points[j]) >= min(sight.comfort, clearances[i:j].min())
