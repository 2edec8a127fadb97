"""Logarithms and exponentials of arrays by additions and products alone: the NumPy twins of `vector_log`.

NumPy's own functions may differ from a kernel's in the last bit, and between processors. These have the kernel's
bits.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Constants of both modules. Bits of 1 and of √½, and the fraction of a float64.
ONE_BITS, ROOT_BITS = np.int64(0x3FF0000000000000), np.int64(0x3FE6A09E667F3BCD)
FRACTION, BIAS, SHIFT = np.int64(0x000FFFFFFFFFFFFF), np.int64(1023), np.int64(52)
RAISE = np.int64(ONE_BITS - ROOT_BITS)
# ln 2 in two parts, the first with few digits, so that k ln 2 is exact.
LN2_HIGH, LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
L1, L2, L3 = 6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01
L4, L5, L6 = 2.222219843214978396e-01, 1.818357216161805012e-01, 1.531383769920937332e-01
L7 = 1.479819860511658591e-01
LOG2_E, C12 = 1.4426950408889634, 1 / 479001600
ROOT_HALF = 0.5**0.5
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
    rest = w * (L2 + w * (L4 + w * L6)) + z * (L1 + w * (L3 + w * (L5 + w * L7)))
    return s * (half + rest) + power * LN2_LOW - half + f + power * LN2_HIGH


def logs(values: Array) -> Array:
    """log x of positive, finite, normal numbers."""
    raised = np.ascontiguousarray(values).view(np.int64) + RAISE
    f = ((raised & FRACTION) + ROOT_BITS).view(np.float64) - 1.0
    return _of_parts(((raised >> SHIFT) - BIAS).astype(np.float64), f)


def log1ps(values: Array) -> Array:
    """log(1 + x) of numbers of at least 0 and at most 1e300."""
    power = (((1.0 + values).view(np.int64) + RAISE) >> SHIFT) - BIAS
    scale = ((BIAS - power) << SHIFT).view(np.float64)
    return _of_parts(power.astype(np.float64), scale * values + (scale - 1.0))


def exps(values: Array) -> Array:
    """e^x of numbers of at most 0; 0 below e^-708."""
    near = np.maximum(values, -708.0)
    whole = np.rint(near * LOG2_E)
    r = near - whole * LN2_HIGH - whole * LN2_LOW
    high = 1 / 5040 + r * (1 / 40320 + r * (1 / 362880 + r * (1 / 3628800 + r * (1 / 39916800 + r * C12))))
    low = 1.0 + r * (1.0 + r * (0.5 + r * (1 / 6 + r * (1 / 24 + r * (1 / 120 + r * (1 / 720 + r * high))))))
    power = ((whole.astype(np.int64) + BIAS) << SHIFT).view(np.float64)
    return np.where(values >= -708.0, low * power, 0.0)


def ndtrs(z: Array) -> Array:
    """Distribution function of the standard normal."""
    x = np.minimum(np.abs(z) * ROOT_HALF, 40.0)
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
