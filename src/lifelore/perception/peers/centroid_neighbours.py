"""k-nearest neighbours on the displacement of centroids: the peer the thesis argues against (§2.3.4, Fig. 2.1)."""

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.peers.pair_classifier import PairClassifier, neighbours


def centroid_displacement(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """From the centroid of `second` to that of `first`, shape ``(3,)``, metres."""
    return first.mean(axis=0) - second.mean(axis=0)


def centroid_neighbours() -> PairClassifier:
    """A classifier on the displacement of centroids alone."""
    return PairClassifier(centroid_displacement, neighbours)
