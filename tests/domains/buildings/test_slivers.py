"""Slivers go, ways stay: worked by hand, and properties on random floors."""

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse import csgraph

from lifelore.domains.buildings.slivers import RIM, without_slivers
from lifelore.domains.grids.grid_world import GridWorld


def corridor(n: int) -> np.ndarray:
    """Cells in a row: east and west moves."""
    east = np.append(np.arange(1, n), -1)
    west = np.arange(-1, n - 1)
    return np.column_stack([np.full(n, -1), np.full(n, -1), east, west]).astype(np.int32)


@pytest.mark.parametrize(
    ("share", "kept"),
    [
        ([1, 1, 1], [1, 1, 1]),
        ([1, 1, 0.1], [1, 1, 0]),  # a dead end
        ([1, 0.1, 1], [1, 1, 1]),  # a door
        ([0.1, 1, 0.1, 0.1, 1, 0.1], [0, 1, 1, 1, 1, 0]),
        ([1, 1, 0.1, 0.1], [1, 1, 0, 0]),  # a rim two deep
        ([1, 1, 0.1, 0.1, 0.1], [1, 1, 1, 1, 1]),  # an aisle
        ([0.1, 0.1, 1], [1, 1, 1]),  # fewer than two large cells: nothing to judge by
    ],
)
def test_corridors(share, kept):
    assert without_slivers(corridor(len(share)), np.array(share, float), 0.5).tolist() == [bool(k) for k in kept]


@pytest.mark.parametrize("seed", range(40))
def test_large_cells_stay_and_stay_joined(seed):
    rng = np.random.default_rng(seed)
    free = rng.random((12, 15)) < 0.75
    neighbour = GridWorld.from_free("floor", free).neighbour
    graph = _graph(neighbour)
    region = csgraph.connected_components(graph, directed=False)[1]
    inside = np.flatnonzero(region == np.bincount(region).argmax())
    number = np.full(len(region) + 1, -1)
    number[inside] = np.arange(len(inside))
    neighbour = number[neighbour[inside]].astype(np.int32)
    share = rng.random(len(inside))
    kept = without_slivers(neighbour, share, 0.6)
    assert kept[share >= 0.6].all()
    assert csgraph.connected_components(_graph(neighbour)[np.ix_(kept, kept)], directed=False)[0] == 1
    # No more than needed: where the large cells hang together, only what leads on beyond the rim stays.
    large = share >= 0.6
    if csgraph.connected_components(_graph(neighbour)[np.ix_(large, large)], directed=False)[0] == 1:
        steps = csgraph.dijkstra(_graph(neighbour), indices=np.flatnonzero(large), unweighted=True, min_only=True)
        assert (kept == large).all() or steps.max() > RIM
        assert kept[steps > RIM].all()


def _graph(neighbour):
    n = len(neighbour)
    tail, move = np.nonzero(neighbour >= 0)
    return sparse.csr_matrix((np.ones(len(tail)), (tail, neighbour[tail, move])), shape=(n, n))
