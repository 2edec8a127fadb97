"""Connected parts of items that are linked in pairs."""

import numpy as np
from numpy.typing import NDArray


def connected_parts(pairs: NDArray[np.int64], n: int) -> NDArray[np.int64]:
    """(n,) int64 number, from 0, of the connected part of each of n items; `pairs` (p, 2) are linked."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    graph = coo_array((np.ones(len(pairs), np.int8), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    return connected_components(graph, directed=False)[1].astype(np.int64)
