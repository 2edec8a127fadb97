"""Distribution functions of the normal and of Student's t, from SciPy.

SciPy is imported at the first call that needs it: a choice by stored tables needs none of these functions.
"""

from functools import cache
from typing import Any

from lifelore.interaction.finite_signals.normal_distribution import ndtr

__all__ = ["gammaln", "ndtr", "stdtr"]


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
