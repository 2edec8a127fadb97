"""Distribution functions of the normal and of Student's t, from SciPy.

SciPy is imported at the first call: a choice by stored tables needs none of these functions.
"""

from functools import cache
from typing import Any


def ndtr(z: Any) -> Any:
    """Distribution function of the standard normal."""
    return _special().ndtr(z)


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
