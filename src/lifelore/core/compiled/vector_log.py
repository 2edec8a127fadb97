"""Logarithms and exponentials for loops of kernels, without branches or calls, so that several run at a time.

The logarithm is that of fdlibm (`log`, `log1p`; Sun Microsystems): x = 2^k (1 + f) with 1 + f in [√½, √2), and
log(1 + f) by a polynomial in f / (2 + f). The exponential is 2^k times a polynomial.
"""

import numpy as np

from lifelore.core.compiled.array_log import ERFC
from lifelore.core.compiled.jit import inlined

# Bits of 1 and of √½, and the fraction of a float64.
_ONE_BITS, _ROOT_BITS = np.int64(0x3FF0000000000000), np.int64(0x3FE6A09E667F3BCD)
_FRACTION, _BIAS, _SHIFT = np.int64(0x000FFFFFFFFFFFFF), np.int64(1023), np.int64(52)
_RAISE = np.int64(_ONE_BITS - _ROOT_BITS)
# ln 2 in two parts, the first with few digits, so that k ln 2 is exact.
_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
_L1, _L2, _L3 = 6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01
_L4, _L5, _L6 = 2.222219843214978396e-01, 1.818357216161805012e-01, 1.531383769920937332e-01
_L7 = 1.479819860511658591e-01
_LOG2_E, _C12 = 1.4426950408889634, 1 / 479001600

_ROOT_HALF = 0.5**0.5
(
    _E0,
    _E1,
    _E2,
    _E3,
    _E4,
    _E5,
    _E6,
    _E7,
    _E8,
    _E9,
    _E10,
    _E11,
    _E12,
    _E13,
    _E14,
    _E15,
    _E16,
    _E17,
    _E18,
    _E19,
    _E20,
    _E21,
    _E22,
    _E23,
    _E24,
    _E25,
    _E26,
    _E27,
) = ERFC


@inlined
def _of_parts(power, f):
    """power ln 2 + log(1 + f) for 1 + f in [√½, √2)."""
    half = 0.5 * f * f
    s = np.divide(f, 2.0 + f)
    z = s * s
    w = z * z
    rest = w * (_L2 + w * (_L4 + w * _L6)) + z * (_L1 + w * (_L3 + w * (_L5 + w * _L7)))
    return s * (half + rest) + power * _LN2_LOW - half + f + power * _LN2_HIGH


@inlined
def plain_log(x):
    """log x of a positive, finite, normal float64."""
    raised = np.float64(x).view(np.int64) + _RAISE
    f = np.int64((raised & _FRACTION) + _ROOT_BITS).view(np.float64) - 1.0
    return _of_parts(float((raised >> _SHIFT) - _BIAS), f)


@inlined
def plain_log1p(x):
    """log(1 + x) of a float64 of at least 0 and at most 1e300, also where 1 + x rounds to 1."""
    power = ((np.float64(1.0 + x).view(np.int64) + _RAISE) >> _SHIFT) - _BIAS
    scale = np.int64((_BIAS - power) << _SHIFT).view(np.float64)
    # Both terms are exact, so for a small x, where the power is 0, no digit is lost.
    return _of_parts(float(power), scale * x + (scale - 1.0))


@inlined
def plain_exp(x):
    """e^x of a float64 of at most 0; 0 below e^-708. The error is below 4e-16 relative."""
    near = max(x, -708.0)
    whole = np.rint(near * _LOG2_E)
    r = near - whole * _LN2_HIGH - whole * _LN2_LOW
    high = 1 / 5040 + r * (1 / 40320 + r * (1 / 362880 + r * (1 / 3628800 + r * (1 / 39916800 + r * _C12))))
    low = 1.0 + r * (1.0 + r * (0.5 + r * (1 / 6 + r * (1 / 24 + r * (1 / 120 + r * (1 / 720 + r * high))))))
    power = np.int64((np.int64(whole) + _BIAS) << _SHIFT).view(np.float64)
    return low * power if x >= -708.0 else 0.0


@inlined
def plain_ndtr(z):
    """Distribution function of the standard normal, to a few units in the last place."""
    x = min(abs(z) * _ROOT_HALF, 40.0)
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
