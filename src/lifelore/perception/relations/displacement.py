"""The thesis's classifier of displacements between contact points: votes of the k nearest neighbours (§2.3.5)."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree


def short_enough(
    displacements: NDArray[np.float64], codes: NDArray[np.int64], omega: float | None
) -> NDArray[np.bool_]:
    """Which of the displacements (n, 3) are at most ω long, (n,); all without ω.

    Where all displacements of a class in `codes` (n,) are longer, its shortest is one of them.
    """
    length = np.linalg.norm(displacements, axis=1)
    chosen = np.full(len(length), True) if omega is None else length <= omega
    for code in np.unique(codes):
        own = np.flatnonzero(codes == code)
        if not chosen[own].any():
            chosen[own[length[own].argmin()]] = True
    return chosen


def votes(
    known: NDArray[np.float64],
    codes: NDArray[np.int64],
    n_classes: int,
    queries: NDArray[np.float64],
    k: int,
    weights: str,
) -> NDArray[np.float64]:
    """Shares of the votes of the k nearest among `known` (n, d), each of the class in `codes` (n,).

    Returns ``(len(asked), n_classes)``, rows sum to 1.
    """
    distance, at = KDTree(known).query(queries, k=[*range(1, min(k, len(known)) + 1)])  # type: ignore[arg-type]
    vote = np.ones_like(distance) if weights == "uniform" else _inverse(distance)
    shares = np.zeros((len(queries), n_classes))
    np.add.at(shares, (np.arange(len(queries))[:, None], codes[at]), vote)
    return shares / shares.sum(axis=1, keepdims=True)


def _inverse(distance: NDArray[np.float64]) -> NDArray[np.float64]:
    """1 / distance; a neighbour at distance 0 alone votes."""
    at_place = distance == 0
    found = at_place.any(axis=1, keepdims=True)
    return np.where(found, at_place, 1.0 / np.where(at_place, 1.0, distance))
