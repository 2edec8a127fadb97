"""Logarithms and exponentials of arrays by additions and products alone: the NumPy twins of `vector_log`.

NumPy's own functions may differ from a kernel's in the last bit, and between processors. These have the kernel's
bits.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_ONE_BITS, _ROOT_BITS = np.int64(0x3FF0000000000000), np.int64(0x3FE6A09E667F3BCD)
_FRACTION, _BIAS, _SHIFT = np.int64(0x000FFFFFFFFFFFFF), np.int64(1023), np.int64(52)
_RAISE = np.int64(_ONE_BITS - _ROOT_BITS)
_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
_L1, _L2, _L3 = 6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01
_L4, _L5, _L6 = 2.222219843214978396e-01, 1.818357216161805012e-01, 1.531383769920937332e-01
_L7 = 1.479819860511658591e-01
_LOG2_E, _C12 = 1.4426950408889634, 1 / 479001600


_ROOT_HALF = 0.5**0.5
# log(erfc(x) / t) + x² by powers of 2 t − 1 with t = 2 / (2 + x), from the Chebyshev series of Numerical Recipes.
ERFC = (
    -0.6717940840566923,
    0.6726432239776567,
    0.047343306841904534,
    -0.04689561023117734,
    -0.009872689366392282,
    0.008824938557113696,
    0.0017589335578087361,
    -0.002345812501075328,
    -0.00014624686329855997,
    0.0006736787991385599,
    -9.3735032187904e-05,
    -0.000174302959455232,
    7.1401019131904e-05,
    3.174520193024e-05,
    -3.0187899002880004e-05,
    1.3772128256000025e-07,
    8.562650611712e-06,
    -2.948059037696e-06,
    -1.272346443776e-06,
    1.2502106112000001e-06,
    -1.684684144640001e-07,
    -2.4981274624000006e-07,
    1.533269770240001e-07,
    1.6106127359999997e-09,
    -3.916641075200003e-08,
    1.1106516991999998e-08,
    4.060086272e-09,
    -1.879048192e-09,
)


def _of_parts(power: Array, f: Array) -> Array:
    half = 0.5 * f * f
    s = f / (2.0 + f)
    z = s * s
    w = z * z
    rest = w * (_L2 + w * (_L4 + w * _L6)) + z * (_L1 + w * (_L3 + w * (_L5 + w * _L7)))
    return s * (half + rest) + power * _LN2_LOW - half + f + power * _LN2_HIGH


def logs(values: Array) -> Array:
    """log x of positive, finite, normal numbers."""
    raised = np.ascontiguousarray(values).view(np.int64) + _RAISE
    f = ((raised & _FRACTION) + _ROOT_BITS).view(np.float64) - 1.0
    return _of_parts(((raised >> _SHIFT) - _BIAS).astype(np.float64), f)


def log1ps(values: Array) -> Array:
    """log(1 + x) of numbers of at least 0 and at most 1e300."""
    power = (((1.0 + values).view(np.int64) + _RAISE) >> _SHIFT) - _BIAS
    scale = ((_BIAS - power) << _SHIFT).view(np.float64)
    return _of_parts(power.astype(np.float64), scale * values + (scale - 1.0))


def exps(values: Array) -> Array:
    """e^x of numbers of at most 0; 0 below e^-708."""
    near = np.maximum(values, -708.0)
    whole = np.rint(near * _LOG2_E)
    r = near - whole * _LN2_HIGH - whole * _LN2_LOW
    high = 1 / 5040 + r * (1 / 40320 + r * (1 / 362880 + r * (1 / 3628800 + r * (1 / 39916800 + r * _C12))))
    low = 1.0 + r * (1.0 + r * (0.5 + r * (1 / 6 + r * (1 / 24 + r * (1 / 120 + r * (1 / 720 + r * high))))))
    power = ((whole.astype(np.int64) + _BIAS) << _SHIFT).view(np.float64)
    return np.where(values >= -708.0, low * power, 0.0)


def ndtrs(z: Array) -> Array:
    """Distribution function of the standard normal."""
    x = np.minimum(np.abs(z) * _ROOT_HALF, 40.0)
    t = 2.0 / (2.0 + x)
    u = 2.0 * t - 1.0
    square = u * u
    v = square * square
    a, b, c, d = (_power_sum(ERFC[first::4], v) for first in range(4))
    f = (a + u * b) + square * (c + u * d)
    half = 0.5 * (t * exps(np.minimum(f - x * x, 0.0)))
    return np.where(z < 0, half, 1.0 - half)


def _power_sum(coefficients: tuple[float, ...], v: Array) -> Array:
    total = np.full(v.shape, coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        total = total * v + coefficient
    return total
