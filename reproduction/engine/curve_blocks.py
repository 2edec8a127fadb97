"""Learning curves stored as means over blocks of episodes that grow with the logarithm of the episode."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

BLOCKS = 48
"""Points of a stored learning curve, nearly evenly spread over the logarithm of the episode."""


def block_edges(n_episodes: int) -> NDArray[np.int64]:
    """Edges of the stored curve's blocks of episodes, from 0 to `n_episodes`: single ones first, then longer."""
    spread = np.geomspace(1, n_episodes, min(BLOCKS, n_episodes))
    return np.unique(np.concatenate([[0], np.rint(spread)])).astype(np.int64)


def block_means(returns: NDArray[np.float64]) -> list[float]:
    """The curve's mean in each block of `block_edges`."""
    edges = block_edges(len(returns))
    return (np.add.reduceat(returns, edges[:-1]) / np.diff(edges)).tolist()


def block_centres(edges: ArrayLike) -> NDArray[np.float64]:
    """Where a logarithmic axis draws each block: the geometric mean of its first and last episode, from 1."""
    edges = np.asarray(edges)
    return np.sqrt((edges[:-1] + 1) * edges[1:])
