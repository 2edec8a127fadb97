"""Leave out slivers of space along walls, and never the way to anywhere.

Where a wall or a table cuts a square, the piece of free space left may be a strip a robot can touch and not
stand in. Such a cell is no place of its own; yet where a narrow door falls on a cell border, strips are all
there is to walk through. So of the small cells those stay that join larger places.
"""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

RIM = 2
"""Cells: how far slivers may reach from larger places and still be no more than their ragged rim."""


def without_slivers(neighbour: NDArray[np.int32], share: NDArray[np.float64], least: float) -> NDArray[np.bool_]:
    """Which cells of a connected region to keep, (n,) bool; what is kept is connected.

    Parameters
    ----------
    neighbour : (n, 4) int
        Cells that moves lead to, -1 for none; moves go both ways.
    share : (n,) float
        Part of its square that each cell's free piece covers, in (0, 1].
    least : float
        Cells covering at least this stay; smaller ones only where larger places are joined by nothing else,
        along the shortest way, and where they lead on for more than `RIM` cells: an aisle, no rim. Where
        fewer than two cells are large enough, all stay.
    """
    large = share >= least
    if large.all() or large.sum() < 2:
        return np.ones(len(share), dtype=bool)
    tail, move = np.nonzero(neighbour >= 0)
    head = neighbour[tail, move]
    graph = sparse.csr_array((np.ones(len(tail)), (tail, head)), shape=(len(share),) * 2)
    steps, before, source = csgraph.dijkstra(
        graph, indices=np.flatnonzero(large), unweighted=True, min_only=True, return_predecessors=True
    )
    # Regions of large cells, each small cell counted to the region it is nearest to.
    both = large[tail] & large[head]
    joined = sparse.csr_array((np.ones(both.sum()), (tail[both], head[both])), shape=graph.shape)
    region = csgraph.connected_components(joined, directed=False)[1][source]
    keep = large.copy()
    for end in _shortest_bridges(region, tail, head, steps):
        _keep_way(end, keep, before)
    for end in np.flatnonzero(steps > RIM):
        _keep_way(end, keep, before)
    return keep


def _keep_way(end, keep: NDArray[np.bool_], before: NDArray) -> None:
    while not keep[end]:
        keep[end] = True
        end = before[end]


def _shortest_bridges(region: NDArray, tail: NDArray, head: NDArray, steps: NDArray) -> NDArray:
    """Both ends of the edges where a shortest tree of ways between regions crosses from one to the next."""
    across = region[tail] < region[head]
    tail, head = tail[across], head[across]
    length = steps[tail] + steps[head] + 1
    order = np.lexsort((head, tail, length, region[head], region[tail]))
    pairs = np.column_stack([region[tail], region[head]])[order]
    order = order[np.unique(pairs, axis=0, return_index=True)[1]]
    tail, head, length = tail[order], head[order], length[order]
    n = int(region.max()) + 1
    tree = csgraph.minimum_spanning_tree(
        sparse.csr_array((length, (region[tail], region[head])), shape=(n, n))
    ).tocoo()
    chosen = np.isin(region[tail] * n + region[head], tree.coords[0] * n + tree.coords[1])
    return np.concatenate([tail[chosen], head[chosen]])
