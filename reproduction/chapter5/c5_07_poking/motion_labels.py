"""Assignment of surface patches to motions: least cost of the patches, plus the length of borders between motions.

Solved by expansion moves (Boykov et al. 2001): in turn each motion takes the patches that lower the sum, the best
such set by a minimum cut.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, maximum_flow

_SCALE = 1000
"""Costs become whole numbers of thousandths, which the flow needs."""
_ROUNDS = 5


def motion_labels(
    costs: NDArray[np.float64], pairs: NDArray[np.int64], weights: NDArray[np.float64]
) -> NDArray[np.int64]:
    """(k,) the motion of each patch, from 0.

    Parameters
    ----------
    costs : (k, m) float64
        Of patch and motion, at least 0.
    pairs : (e, 2) int64
        Neighbours, each pair once.
    weights : (e,) float64
        Cost of two neighbours with different motions, at least 0.
    """
    labels = costs.argmin(axis=1).astype(np.int64)
    least = _energy(costs, pairs, weights, labels)
    for _ in range(_ROUNDS):
        before = least
        for motion in range(costs.shape[1]):
            tried = _expanded(costs, pairs, weights, labels, motion)
            energy = _energy(costs, pairs, weights, tried)
            if energy < least - 1e-9:
                labels, least = tried, energy
        if least >= before:
            break
    return labels


def _energy(costs: NDArray, pairs: NDArray, weights: NDArray, labels: NDArray) -> float:
    differ = labels[pairs[:, 0]] != labels[pairs[:, 1]]
    return float(costs[np.arange(len(costs)), labels].sum() + weights[differ].sum())


def _expanded(costs: NDArray, pairs: NDArray, weights: NDArray, labels: NDArray, motion: int) -> NDArray[np.int64]:
    """The labels after the best expansion of a motion: a cut leaves patches on the sink's side as they are."""
    k = len(costs)
    source, sink = k, k + 1
    stay, take = costs[np.arange(k), labels].copy(), costs[:, motion].copy()
    stay[labels == motion] = take[labels == motion]
    a, b = pairs.T
    la, lb = labels[a], labels[b]
    # Pair energies: both stay E00, a stays and b takes E01, a takes and b stays E10, both take 0.
    e00, e01, e10 = weights * (la != lb), weights * (la != motion), weights * (lb != motion)
    # E = const + take_a (E10 - E00) + take_b (-E10) + (1 - take_a) take_b (E01 + E10 - E00)
    linear = np.bincount(a, e10 - e00, k) - np.bincount(b, e10, k)
    link = e01 + e10 - e00
    unary = take + linear - stay
    # A patch on the source's side takes; an edge from b to a is cut where b takes and a stays.
    rows = np.concatenate([np.full(k, source), np.arange(k), b])
    columns = np.concatenate([np.arange(k), np.full(k, sink), a])
    values = np.concatenate([np.maximum(-unary, 0), np.maximum(unary, 0), link])
    graph = coo_array((np.round(_SCALE * values).astype(np.int32), (rows, columns)), shape=(k + 2, k + 2)).tocsr()
    graph.sum_duplicates()
    flow = maximum_flow(graph, source, sink).flow
    residual = (graph - flow).tocsr()
    residual.data = np.maximum(residual.data, 0)
    residual.eliminate_zeros()
    reached = breadth_first_order(residual, source, return_predecessors=False)
    taken = np.zeros(k + 2, bool)
    taken[reached] = True
    return np.where(taken[:k], motion, labels)
