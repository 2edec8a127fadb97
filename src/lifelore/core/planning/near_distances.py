"""Steps between the known places of a grid: exact nearby, estimated farther away."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from lifelore.core.compiled.jit import kernel

TABLE_SIZE = 16e6
"""Entries of a table of distances (2 bytes each); more reach farther and take more time and main memory."""
MOST_REACH = 30
"""Largest distance of rows or columns within which steps are exact."""
N_NEAREST = 10
"""Neighbours of each place that a tour tries; more cost time and hardly shorten the tour."""
BEYOND = -1


class NearDistances(NamedTuple):
    """Steps between places that are near each other.

    A move that is known in one direction counts in both: tours are planned on these distances, and walked on the
    known moves.

    cells : (n_states, 2) int32, row and column of each state
    steps : (n_states, side, side) int16, steps to the state in the cell at each offset; BEYOND where no path
        inside the window is known. side = 2 · reach + 1.
    nearest : (n_states, N_NEAREST) int32, the nearest states in order; -1 where there are fewer
    """

    cells: NDArray[np.int32]
    steps: NDArray[np.int16]
    nearest: NDArray[np.int32]


def known_neighbours(target: NDArray[np.int32]) -> sparse.csr_array:
    """The graph of known moves between different states, each in both directions, (n_states, n_states)."""
    state, action = np.nonzero((target >= 0) & (target != np.arange(len(target))[:, None]))
    ends = target[state, action]
    pairs = np.ones(2 * len(state), np.int8), (np.r_[state, ends], np.r_[ends, state])
    graph = sparse.csr_array(pairs, shape=(len(target),) * 2)
    graph.sum_duplicates()
    return graph


def near_distances(graph: sparse.csr_array, cells: NDArray[np.integer]) -> NearDistances:
    """Distances in a graph of `known_neighbours`; `cells` (n_states, 2) holds each state's row and column."""
    n = len(cells)
    reach = min(MOST_REACH, int((TABLE_SIZE / n) ** 0.5 - 1) // 2)
    cells = np.ascontiguousarray(cells, np.int32)
    steps, nearest = _search(graph.indptr.astype(np.int32), graph.indices.astype(np.int32), cells, reach)
    return NearDistances(cells, steps, nearest)


@kernel
def _search(begin, ends, cells, reach):
    """Steps and nearest states as in `NearDistances`: breadth first from each state inside its window."""
    n, side = len(cells), 2 * reach + 1
    steps = np.full((n, side, side), np.int16(BEYOND))
    nearest = np.full((n, N_NEAREST), np.int32(-1))
    queue = np.empty(n, np.int32)
    for start in range(n):
        top, left = cells[start, 0] - reach, cells[start, 1] - reach
        steps[start, reach, reach] = 0
        queue[0] = start
        head, tail = 0, 1
        while head < tail:
            s = queue[head]
            head += 1
            here = steps[start, cells[s, 0] - top, cells[s, 1] - left]
            for k in range(begin[s], begin[s + 1]):
                t = ends[k]
                row, column = cells[t, 0] - top, cells[t, 1] - left
                if 0 <= row < side and 0 <= column < side and steps[start, row, column] == BEYOND:
                    steps[start, row, column] = here + 1
                    if tail <= nearest.shape[1]:
                        nearest[start, tail - 1] = t
                    queue[tail] = t
                    tail += 1
    return steps, nearest


@kernel
def steps_between(a, b, near):
    """Steps from state `a` to state `b`: exact inside the window, else one and a half times the straight way."""
    if a > b:  # windows differ, so the way back could be longer: the same answer both ways
        a, b = b, a
    cells, steps, _ = near
    reach = steps.shape[1] // 2
    down, right = cells[b, 0] - cells[a, 0], cells[b, 1] - cells[a, 1]
    far = abs(down) + abs(right)
    if abs(down) > reach or abs(right) > reach:
        return far + far // 2
    found = np.int64(steps[a, down + reach, right + reach])
    return found if found != BEYOND else far + 2 * reach
