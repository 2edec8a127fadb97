"""Computes the shortest path in metres that stays clear of obstacles, at any angle, by what is known about moves.

A path from cell to cell is not a path for a robot: the line between the centres of two cells may cross a wall, and
four directions make a path up to √2 times too long. Here Lazy Theta* searches over the pixels of the cells' own
pieces of free space: a path turns at any pixel near an obstacle, and on open floor at the pixels of a coarser
lattice, in any direction. The corners that it finds are then moved by fractions of a pixel until no move makes the
path cheaper.

Source: Nash, Koenig and Tovey, Lazy Theta*: Any-Angle Path Planning and Path Length Analysis in 3D, AAAI 2010.
Added here: lines have prices, so the cost of a line is known when it is measured; its end is then queued again.
`cost_ahead` estimates the costs that lead the search.
"""

import heapq
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.domains.buildings.cost_ahead import cost_ahead, cost_ahead_of
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.line_of_sight import TIGHT, ground_of, line_cost, near_solid

_STRIDE, _STRIDES_PER_CELL = 4, 3
"""Most pixels between two nodes on open floor, and least number of such steps through a cell: a path may be known
cell by cell. A larger stride takes less time, and finds the corners where prices change less exactly."""
_SHIFTS = 0.618 ** np.arange(-3, 6)
"""Pixels: how far corners are moved in the end, 4.2 to 0.09; smaller ones make the path shorter, slower. Powers of
the golden ratio never add up to the border between two pixels."""


def clear_path(
    floor: Floor,
    start: tuple[float, float],
    goal: tuple[float, float],
    price: NDArray[np.floating] | None = None,
    clearance: float | None = None,
) -> NDArray[np.float64] | None:
    """The cheapest path of straight segments from `start` to `goal`, (n, 2) in metres of the map's frame.

    Parameters
    ----------
    floor : Floor
    start, goal : (x, y)
        Points in metres, free places of the floor (`Floor.state_at`).
    price : (n_states, 4) float, optional
        Metres, at least 0, that each move costs in addition to its length: time lost, risk. A path changes from
        the piece of one state to that of another only by moves of finite price. Default: 0 wherever pieces touch.
    clearance : float, optional
        Metres from the centres of solid pixels that the path keeps wherever it can; default: the robot's radius
        and half a pixel. A passage that leaves less costs `TIGHT` times its length more.

    Returns
    -------
    (n, 2) float, or None
        From `start` to `goal`; None if no moves join them. Every segment lies in pixels of the floor, and farther
        than the robot's radius from the centre of every solid pixel.
    """
    ends = floor.pixels([start, goal])
    ground = ground_of(floor, np.zeros((floor.n_states, 4)) if price is None else price, clearance)
    cell = math.sqrt(np.count_nonzero(floor.state >= 0) / floor.n_states)
    stride = min(max(int(cell / _STRIDES_PER_CELL), 1), _STRIDE)
    nodes = near_solid(floor, ground.wanted + stride + 2).copy()
    nodes[::stride, ::stride] = True
    nodes &= floor.state >= 0
    corners = _search(ground, ends, cost_ahead_of(floor, ground.price, ends[1]), nodes, stride)
    if not len(corners):
        return None
    path = floor.metres(_pulled(ground, corners, _SHIFTS))
    path[0], path[-1] = start, goal
    return path[np.r_[True, (np.diff(path, axis=0) != 0).any(axis=1)]]


@kernel
def _point(ends, columns, node):
    """Row and column of a node: -2 is the start, -1 the goal, others are flat pixel numbers."""
    if node < 0:
        return ends[node + 2, 0], ends[node + 2, 1]
    return float(node // columns), float(node % columns)


@kernel
def _line(ground, ends, a, b):
    """Cost of the line from node to node. An end point and its own pixel are joined in any case."""
    columns = ground.state.shape[1]
    row, column = _point(ends, columns, a)
    last_row, last_column = _point(ends, columns, b)
    cost = line_cost(ground, row, column, last_row, last_column)
    if cost == np.inf and (a < 0) != (b < 0) and max(abs(last_row - row), abs(last_column - column)) <= 0.5:
        return (1 + TIGHT) * math.hypot(last_row - row, last_column - column)
    return cost


@kernel
def _around(nodes, ends, node, stride, found):
    """Write the nodes next to a node to `found`; their number.

    `nodes` (rows, columns) are the pixels at which a path may turn: those near an obstacle, and those of the
    lattice. Next to a node lie those around it, the corners of its square of the lattice, and ends that lie near.
    A pixel of the lattice has all nodes in its four squares, and so has an end.
    """
    rows, columns = nodes.shape
    row, column = _point(ends, columns, node)
    at_row, at_column = math.floor(row + 0.5), math.floor(column + 0.5)
    in_lattice = at_row % stride == at_column % stride == 0
    reach = stride if node < 0 or in_lattice else 1
    n = 0
    for i in range(max(at_row - reach, 0), min(at_row + reach + 1, rows)):
        for j in range(max(at_column - reach, 0), min(at_column + reach + 1, columns)):
            if nodes[i, j] and i * columns + j != node:
                found[n] = i * columns + j
                n += 1
    if reach < stride:
        for i in (at_row - at_row % stride, at_row - at_row % stride + stride):
            for j in (at_column - at_column % stride, at_column - at_column % stride + stride):
                if i < rows and j < columns and nodes[i, j]:
                    found[n] = i * columns + j
                    n += 1
    for end in range(-2, 0):
        away = max(abs(ends[end + 2, 0] - at_row), abs(ends[end + 2, 1] - at_column))
        if away <= stride + 0.5 and end != node:
            found[n] = end
            n += 1
    return n


@kernel
def _ahead(ground, ends, node, ahead):
    """The cost estimated from a node to the goal."""
    row, column = _point(ends, ground.state.shape[1], node)
    return cost_ahead(ahead, ground.state[math.floor(row + 0.5), math.floor(column + 0.5)], row, column)


@kernel
def _search(ground, ends, costs_ahead, nodes, stride):
    """Lazy Theta*: points (n, 2) of the cheapest path, none if there is none."""
    columns = ground.state.shape[1]
    n_nodes = ground.state.size + 2  # the two ends are the last, by their negative numbers
    cost, before = np.full(n_nodes, np.inf), np.full(n_nodes, -2, np.int64)
    measured, closed = np.zeros(n_nodes, np.bool_), np.zeros(n_nodes, np.bool_)
    beside = np.empty((2 * stride + 1) ** 2 + 6, np.int64)
    cost[-2], measured[-2] = 0.0, True
    queue: Any = [(_ahead(ground, ends, -2, costs_ahead), -2)]
    while queue:
        bound, node = heapq.heappop(queue)
        if bound == np.inf:
            break  # no moves lead to the goal
        ahead = _ahead(ground, ends, node, costs_ahead)
        if closed[node] or bound > cost[node] + ahead + 1e-9:
            continue
        n = _around(nodes, ends, node, stride, beside)
        if not measured[node]:
            lower = cost[node]
            _measure(ground, ends, node, beside[:n], cost, before, closed)
            measured[node] = True
            if cost[node] > lower + 1e-9:
                if cost[node] < np.inf:
                    heapq.heappush(queue, (cost[node] + ahead, node))
                continue
        closed[node] = True
        if node == -1:
            break
        origin = before[node]
        from_row, from_column = _point(ends, columns, origin)
        for k in range(n):
            there = beside[k]
            if closed[there]:
                continue
            row, column = _point(ends, columns, there)
            at_least = cost[origin] + math.hypot(row - from_row, column - from_column)
            if at_least < cost[there] - 1e-9:
                cost[there], before[there], measured[there] = at_least, origin, False
                heapq.heappush(queue, (at_least + _ahead(ground, ends, there, costs_ahead), there))
    return _corners(ends, columns, before, closed)


@kernel
def _measure(ground, ends, node, beside, cost, before, closed):
    """Set the node's cost by measured lines: from the origin assumed, closed neighbours, or their origins."""
    chosen, last, best = before[node], before[node], np.inf
    lower = cost[node]
    for k in range(-1, 2 * len(beside)):
        # The origin assumed comes first; then each neighbour, and the origin of each.
        near = chosen if k < 0 else beside[k // 2]
        if k >= 0 and not closed[near]:
            continue
        if k % 2 == 0 and k >= 0:
            near = before[near]
            if near == last:
                continue
            last = near
        row, column = _point(ends, ground.state.shape[1], node)
        from_row, from_column = _point(ends, ground.state.shape[1], near)
        if cost[near] + math.hypot(row - from_row, column - from_column) < best - 1e-9:
            through = cost[near] + _line(ground, ends, near, node)
            if through < best:
                best, chosen = through, near
        if k < 0 and best <= lower + 1e-9:
            break
    cost[node], before[node] = best, chosen


@kernel
def _corners(ends, columns, before, closed):
    n, node = 1, -1
    while closed[-1] and node != -2:
        node = before[node]
        n += 1
    points = np.empty((n if closed[-1] else 0, 2))
    node = -1
    for k in range(len(points) - 1, -1, -1):
        points[k] = _point(ends, columns, node)
        node = before[node]
    return points


@kernel
def _pulled(ground, points, shifts):
    """Leave out corners and move the others by `shifts` for as long as the path becomes cheaper."""
    points = points.copy()
    n = len(points)
    for shift in shifts:
        changed = True
        while changed:
            changed = False
            k = 1
            while k < n - 1:
                now = _cost_by(ground, points, k, 1)
                if _cost_by(ground, points, k, 2) <= now + 1e-9:
                    points[k : n - 1] = points[k + 1 : n].copy()
                    n -= 1
                    changed = True
                    k = max(k - 1, 1)
                    continue
                for direction in range(9):
                    down, right = shift * (direction // 3 - 1), shift * (direction % 3 - 1)
                    points[k, 0] += down
                    points[k, 1] += right
                    cost = _cost_by(ground, points, k, 1)
                    if cost < now - 1e-6:
                        now, changed = cost, True
                    else:
                        points[k, 0] -= down
                        points[k, 1] -= right
                k += 1
    return points[:n]


@kernel
def _cost_by(ground, points, k, step):
    """Cost from the point before point k to the point after it: through point k, or with `step` 2 past it."""
    row, column = math.floor(points[k, 0] + 0.5), math.floor(points[k, 1] + 0.5)
    if (
        not (0 <= row < ground.state.shape[0] and 0 <= column < ground.state.shape[1])
        or ground.state[row, column] < 0
    ):
        return np.inf
    cost = 0.0
    for i in range(k - 1, k + 1, step):
        j = i + step
        cost += line_cost(ground, points[i, 0], points[i, 1], points[j, 0], points[j, 1])
    return cost
