"""Bayes' rule and the step of a hazard in a single pass for a single belief, in NumPy: the twin of `hazard_row`.

    w(τ) = F(σ | τ, π) β(τ),      β'(τ) = (1 - h) w(τ) / Σ w + h G₀(τ)

The belief is linear between the two steps, so a type costs one exponential and one logarithm. The logarithm is a
polynomial (of fdlibm, exact to a unit in the last place) that processors compute for several types at a time.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.beliefs.bayes_rule import LOWEST

Array = NDArray[np.float64]

LEAST_ANEW = {"f8": 1e-290, "f4": 1e-30}
"""Types whose h G₀ is smaller take the step by their logarithm: their belief may leave the range of numbers."""

# A positive number is 2^k (1 + f) with 1 + f from √½ to √2. Its bits give k and f.
ABOVE, EXPONENT_AT, BIAS = np.uint64(0x00095F619980C433), np.uint64(52), 1023.0
MANTISSA, ROOT_HALF = np.uint64(0x000FFFFFFFFFFFFF), np.uint64(0x3FE6A09E667F3BCD)
LN2_HIGH, LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
L1, L2, L3 = 6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01
L4, L5, L6, L7 = (
    2.222219843214978396e-01,
    1.818357216161805012e-01,
    1.531383769920937332e-01,
    1.479819860511658591e-01,
)


class HazardTerms(NamedTuple):
    """The numbers of a hazard's step, as the kernels read them.

    stay : 1 - h
    log_stay : log(1 - h)
    anew : (n_types,) h G₀
    log_anew : (n_types,) log(h G₀)
    small : (k,) int64, types whose h G₀ lies below `LEAST_ANEW`
    """

    stay: float
    log_stay: float
    anew: NDArray
    log_anew: Array
    small: NDArray[np.int64]

    @classmethod
    def of(cls, rate: float, prior: Array, dtype: str = "f8") -> "HazardTerms":
        """The terms of a hazard of `rate` that draws from `prior` (n_types,), for beliefs of precision `dtype`."""
        anew = rate * prior
        with np.errstate(divide="ignore"):
            log_stay, log_anew = float(np.log1p(-rate)), np.log(anew)
        small = np.flatnonzero(anew < LEAST_ANEW[dtype])
        return cls(1.0 - rate, log_stay, anew.astype(dtype), log_anew, small)


def hazard_rule(log_belief: Array, log_likelihood: Array, terms: HazardTerms) -> tuple[Array, float]:
    """The belief (n_types,) before the next episode, and the log evidence; the bits are those of the kernel.

    Where no type explains the signal, the belief takes the step of the hazard alone.
    """
    if not (log_likelihood < np.inf).all():
        return log_belief, np.nan
    possible = log_belief > -np.inf
    best = max(log_likelihood[possible].tolist(), default=-np.inf)
    if best == -np.inf:
        joint, best, explained = log_belief, 0.0, False
    else:
        joint, explained = np.full(log_belief.shape, -np.inf), True
        with np.errstate(over="ignore"):
            joint[possible] = log_belief[possible] + (log_likelihood[possible] - best)
    top = max(joint.tolist())
    near = joint - top
    linear = np.array([math.exp(value) for value in near.tolist()])
    total = 0.0
    for value in linear.tolist():
        total += value
    shift = math.log(total)
    after = logarithms(np.maximum(linear * (terms.stay / total) + terms.anew, LEAST_ANEW["f8"]))
    for i in terms.small.tolist():
        after[i] = log_of_sum(float(near[i]) - shift + terms.log_stay, float(terms.log_anew[i]))
    return np.minimum(after, 0.0), max(top + shift + best, LOWEST) if explained else -np.inf


def logarithms(values: Array) -> Array:
    """Natural logarithms of normal positive numbers, by additions and products alone: the kernel's bits."""
    bits = values.view(np.uint64) + ABOVE
    k = (bits >> EXPONENT_AT).astype(np.float64) - BIAS
    f = ((bits & MANTISSA) + ROOT_HALF).view(np.float64) - 1.0
    half, s = 0.5 * f * f, f / (2.0 + f)
    z = s * s
    w = z * z
    rest = w * (L2 + w * (L4 + w * L6)) + z * (L1 + w * (L3 + w * (L5 + w * L7)))
    return s * (half + rest) + k * LN2_LOW - half + f + k * LN2_HIGH


def log_of_sum(a: float, b: float) -> float:
    """log(exp a + exp b)."""
    high, low = max(a, b), min(a, b)
    return high if low == -math.inf else high + math.log1p(math.exp(low - high))
