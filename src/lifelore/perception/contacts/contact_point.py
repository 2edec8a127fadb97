"""A contact point: where one object comes near another, condensed from the support vectors there."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class ContactPoint:
    """A cluster of support vectors of one object towards another (thesis §2.3.4, χ).

    Parameters
    ----------
    position : (3,) float64
        α-weighted centroid, metres.
    normal : (3,) float64
        Unit vector out of the other object into this one, across the separating surface.
    extent : (3,) float64
        Lengths of the cluster along its principal axes, metres, descending.
    strength : float
        Sum of α over the cluster, > 0.
    n_support : int
        Support vectors in the cluster, ≥ 1.
    other : int
        The object on the far side.
    """

    position: NDArray[np.float64]
    normal: NDArray[np.float64]
    extent: NDArray[np.float64]
    strength: float
    n_support: int
    other: int
