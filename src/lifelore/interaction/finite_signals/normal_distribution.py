"""Distribution function of the standard normal, without SciPy while few numbers are asked for."""

from math import erfc, sqrt
from typing import Any

import numpy as np

FEW = 200_000
"""Count of numbers up to which a process computes them one by one: they take 30 ms, the import of SciPy 170 ms."""
_computed = 0


def ndtr(z: Any) -> Any:
    """P(Z ≤ z) of a number or an array, a float64 or an array of the same shape."""
    global _computed
    z = np.asarray(z, np.float64)
    if _computed + z.size > FEW:
        from scipy.special import ndtr as of_scipy

        return of_scipy(z)
    _computed += z.size
    halves = [0.5 * erfc(x) for x in (-sqrt(0.5) * z).ravel().tolist()]
    return np.array(halves).reshape(z.shape)[()]
