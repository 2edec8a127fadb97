"""The nearest points of two clouds and their distance."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from lifelore.core.compiled.jit import kernel

MOST_PAIRS = 1_000_000
"""Number of pairs of points above which a k-d tree searches; it is quicker there."""


@dataclass(frozen=True, eq=False)
class Nearest:
    """The smallest distance of two clouds, metres, and the point of each cloud there, ``(3,)``."""

    distance: float
    own: NDArray[np.float64]
    other: NDArray[np.float64]


def nearest_points(first: NDArray[np.float64], second: NDArray[np.float64]) -> Nearest | None:
    """The nearest points of two clouds ``(n, 3)`` and ``(m, 3)``, metres; None where either cloud is empty.

    Of equally near points of `first` the lowest row is taken, of those of `second` the result of a k-d tree.
    """
    if not len(first) or not len(second):
        return None
    if len(first) * len(second) > MOST_PAIRS:
        distances, partners = KDTree(second).query(first)
        row = int(np.argmin(distances))
        return Nearest(float(distances[row]), first[row], second[int(np.asarray(partners)[row])])
    distance, row, partner, alone = _nearest_rows(first, second)
    if not alone:
        # The k-d tree decides between equals.
        partner = int(KDTree(second).query(first[row])[1])
    return Nearest(float(distance), first[row], second[partner])


@kernel
def _nearest_rows(first, second):
    """The smallest distance, its row in each cloud, and whether no other row of `second` is as near.

    Distances are compared, not their squares: two squares may have one root.
    """
    best, row, partner, alone = np.inf, 0, 0, True
    for i in range(len(first)):
        least, at, single = np.inf, 0, True
        for j in range(len(second)):
            dx = first[i, 0] - second[j, 0]
            dy = first[i, 1] - second[j, 1]
            dz = first[i, 2] - second[j, 2]
            square = dx * dx + dy * dy + dz * dz
            if square < least:
                least, at, single = square, j, True
            elif square == least:
                single = False
        distance = np.sqrt(least)
        if distance < best:
            best, row, partner, alone = distance, i, at, single
    return best, row, partner, alone
