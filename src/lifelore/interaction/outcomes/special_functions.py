"""The distribution function of Student's t and the gamma function, from SciPy.

SciPy is imported at the first call: a choice for a single user needs none of these functions. The distribution
function of the normal is in `finite_signals.normal_distribution`.
"""

from typing import Any


def stdtr(freedom: Any, t: Any) -> Any:
    """Distribution function of Student's t."""
    from scipy import special

    return special.stdtr(freedom, t)


def gammaln(x: Any) -> Any:
    """Logarithm of the gamma function's absolute value."""
    from scipy import special

    return special.gammaln(x)
