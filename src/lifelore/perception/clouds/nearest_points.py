"""The nearest points of two clouds and their distance."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree


@dataclass(frozen=True, eq=False)
class Nearest:
    """The smallest distance of two clouds, metres, and the point of each cloud there, ``(3,)``."""

    distance: float
    own: NDArray[np.float64]
    other: NDArray[np.float64]


def nearest_points(first: NDArray[np.float64], second: NDArray[np.float64]) -> Nearest | None:
    """The nearest points of two clouds ``(n, 3)`` and ``(m, 3)``, metres; None where either cloud is empty.

    Of equally near points of `first` the lowest row is taken.
    """
    if not len(first) or not len(second):
        return None
    distances, partners = KDTree(second).query(first)
    row = int(np.argmin(distances))
    return Nearest(float(distances[row]), first[row], second[int(np.asarray(partners)[row])])
