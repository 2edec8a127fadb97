"""Log likelihoods of single moves by type, from counts of moves in training. Thesis: §4.8.4.1, §4.8.5.1."""

import numpy as np
from numpy.typing import NDArray

PSEUDO_COUNT = 0.5
"""Observations of every outcome that a learnt model is given beforehand, shared out over the fates."""


def log_shares(counts: NDArray[np.float64], group: int, pseudo_count: float) -> NDArray[np.float64]:
    """Logs of shares within each `group` of the middle axis.

    Parameters
    ----------
    counts : (n_policies, n_groups · group, n_types) float
        At least 0.
    group : int
        Number of outcomes of a context; neighbours on the middle axis.
    pseudo_count : float
        Added to every count, above 0.

    Returns
    -------
    log_shares : (n_policies, n_groups · group, n_types) float64
        Their exponentials sum to 1 over each group.

    Examples
    --------
    >>> counts = np.array([[[3.0], [1.0], [0.0], [0.0]]])
    >>> np.exp(log_shares(counts, 2, 1.0)).ravel().round(3).tolist()
    [0.667, 0.333, 0.5, 0.5]
    """
    n_policies, _, n_types = counts.shape
    parts = counts.reshape(n_policies, -1, group, n_types) + pseudo_count
    return np.log(parts / parts.sum(axis=2, keepdims=True)).reshape(counts.shape)
