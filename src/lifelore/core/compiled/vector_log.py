"""Logarithms and exponentials for loops of kernels, without branches or calls, so that several run at a time.

The logarithm is that of fdlibm (`log`, `log1p`; Sun Microsystems): x = 2^k (1 + f) with 1 + f in [√½, √2), and
log(1 + f) by a polynomial in f / (2 + f). The exponential is 2^k times a polynomial.
"""

import numpy as np

from lifelore.core.compiled.array_log import (
    BIAS,
    C12,
    ERFC,
    FRACTION,
    L1,
    L2,
    L3,
    L4,
    L5,
    L6,
    L7,
    LN2_HIGH,
    LN2_LOW,
    LOG2_E,
    RAISE,
    ROOT_BITS,
    ROOT_HALF,
    SHIFT,
)  # fmt: skip
from lifelore.core.compiled.jit import inlined

# The coefficients of `plain_ndtr`.
(
    _E0, _E1, _E2, _E3, _E4, _E5, _E6, _E7, _E8, _E9, _E10, _E11, _E12, _E13,
    _E14, _E15, _E16, _E17, _E18, _E19, _E20, _E21, _E22, _E23, _E24, _E25, _E26, _E27,
) = ERFC  # fmt: skip


@inlined
def _of_parts(power, f):
    """power ln 2 + log(1 + f) for 1 + f in [√½, √2)."""
    half = 0.5 * f * f
    s = np.divide(f, 2.0 + f)
    z = s * s
    w = z * z
    rest = w * (L2 + w * (L4 + w * L6)) + z * (L1 + w * (L3 + w * (L5 + w * L7)))
    return s * (half + rest) + power * LN2_LOW - half + f + power * LN2_HIGH


@inlined
def plain_log(x):
    """log x of a positive, finite, normal float64."""
    raised = np.float64(x).view(np.int64) + RAISE
    f = np.int64((raised & FRACTION) + ROOT_BITS).view(np.float64) - 1.0
    return _of_parts(float((raised >> SHIFT) - BIAS), f)


@inlined
def plain_log1p(x):
    """log(1 + x) of a float64 of at least 0 and at most 1e300, also where 1 + x rounds to 1."""
    power = ((np.float64(1.0 + x).view(np.int64) + RAISE) >> SHIFT) - BIAS
    scale = np.int64((BIAS - power) << SHIFT).view(np.float64)
    # Both terms are exact, so for a small x, where the power is 0, no digit is lost.
    return _of_parts(float(power), scale * x + (scale - 1.0))


@inlined
def plain_exp(x):
    """e^x of a float64 of at most 0; 0 below e^-708. The error is below 4e-16 relative."""
    near = max(x, -708.0)
    whole = np.rint(near * LOG2_E)
    r = near - whole * LN2_HIGH - whole * LN2_LOW
    high = 1 / 5040 + r * (1 / 40320 + r * (1 / 362880 + r * (1 / 3628800 + r * (1 / 39916800 + r * C12))))
    low = 1.0 + r * (1.0 + r * (0.5 + r * (1 / 6 + r * (1 / 24 + r * (1 / 120 + r * (1 / 720 + r * high))))))
    power = np.int64((np.int64(whole) + BIAS) << SHIFT).view(np.float64)
    return low * power if x >= -708.0 else 0.0


@inlined
def plain_ndtr(z):
    """Distribution function of the standard normal, to a few units in the last place."""
    x = min(abs(z) * ROOT_HALF, 40.0)
    t = np.divide(2.0, 2.0 + x)
    u = 2.0 * t - 1.0
    square = u * u
    v = square * square
    # Four short sums rather than a long one, whose every step would wait for the last.
    a = (((((_E24 * v + _E20) * v + _E16) * v + _E12) * v + _E8) * v + _E4) * v + _E0
    b = (((((_E25 * v + _E21) * v + _E17) * v + _E13) * v + _E9) * v + _E5) * v + _E1
    c = (((((_E26 * v + _E22) * v + _E18) * v + _E14) * v + _E10) * v + _E6) * v + _E2
    d = (((((_E27 * v + _E23) * v + _E19) * v + _E15) * v + _E11) * v + _E7) * v + _E3
    f = (a + u * b) + square * (c + u * d)
    half = 0.5 * (t * plain_exp(min(f - x * x, 0.0)))
    return half if z < 0 else 1.0 - half
