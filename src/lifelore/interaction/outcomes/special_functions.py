"""Distribution functions of the normal and of Student's t, from SciPy.

SciPy is imported at the first call that needs it: a choice by stored tables needs none of these functions.
"""

from functools import cache
from math import erfc, sqrt
from typing import Any

import numpy as np

FEW = 30_000
"""Count of numbers up to which a process computes `ndtr` without SciPy: the import takes as long as some hundred
thousand of them."""
_computed = 0


def ndtr(z: Any) -> Any:
    """Distribution function of the standard normal, of a number or an array; one number at a time while few."""
    global _computed
    z = np.asarray(z, np.float64)
    if _computed + z.size > FEW:
        return _special().ndtr(z)
    _computed += z.size
    halves = [0.5 * erfc(x) for x in (-sqrt(0.5) * z).ravel().tolist()]
    return np.array(halves).reshape(z.shape)[()]


def stdtr(freedom: Any, t: Any) -> Any:
    """Distribution function of Student's t."""
    return _special().stdtr(freedom, t)


def gammaln(x: Any) -> Any:
    """Logarithm of the gamma function's absolute value."""
    return _special().gammaln(x)


@cache
def _special() -> Any:
    from scipy import special

    return special
