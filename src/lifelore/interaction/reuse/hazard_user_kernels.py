"""Compiled kernel for float32 beliefs of many users: Bayes' rule and the step of a hazard in a single pass."""

import math

import numpy as np

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.interaction.beliefs.hazard_kernels import log_of_sum
from lifelore.interaction.reuse.user_kernels import AHEAD, _exponentials, _joined, _total, _touched

# A positive number is 2^k (1 + f) with 1 + f from √½ to √2. Its bits give k and f.
_ABOVE, _EXPONENT_AT, _BIAS = np.int32(0x3F800000 - 0x3F3504F3), np.int32(23), np.int32(127)
_MANTISSA, _ROOT_HALF = np.int32(0x007FFFFF), np.int32(0x3F3504F3)
_LN2_HIGH, _LN2_LOW = np.float32(6.9313812256e-01), np.float32(9.0580006145e-06)
_L1, _L2, _L3, _L4 = (
    np.float32(0.66666662693),
    np.float32(0.40000972152),
    np.float32(0.28498786688),
    np.float32(0.24279078841),
)
_HALF, _ONE, _TWO, _ZERO = np.float32(0.5), np.float32(1.0), np.float32(2.0), np.float32(0.0)


@inlined
def _logarithms(value_bits, bits, powers, exponents, out):
    """out = min(log(values), 0) of float32, seen as int32; `powers` is `bits` seen as float32, both written."""
    n = out.shape[0]
    for i in range(n):
        moved = np.int32(value_bits[i] + _ABOVE)
        exponents[i] = np.float32(np.int32(np.int32(moved >> _EXPONENT_AT) - _BIAS))
        bits[i] = np.int32(moved & _MANTISSA) + _ROOT_HALF
    for i in range(n):
        k, f = exponents[i], powers[i] - _ONE
        half, s = _HALF * f * f, np.divide(f, _TWO + f)
        z = s * s
        w = z * z
        rest = w * (_L2 + w * _L4) + z * (_L1 + w * _L3)
        out[i] = min(s * (half + rest) + k * _LN2_LOW - half + f + k * _LN2_HIGH, _ZERO)


@kernel
def _write_small(row, near, shift, terms):
    """Logarithms of types whose h G₀ is small; a function of its own keeps the loops of the caller fast."""
    for i in terms.small:
        row[i] = min(log_of_sum(float(near[i]) - shift + terms.log_stay, terms.log_anew[i]), 0.0)


@kernel
def hazard_users_f4(log_beliefs, users, log_likelihood, linear, log_evidence, terms):
    """As `bayes_users_f4`, then the step of the hazard, which users of unexplained signals take too.

    terms : HazardTerms
        With float32 `anew`.
    """
    stay, anew, any_small = terms.stay, terms.anew, terms.small.shape[0] > 0
    n, linear_bits = log_likelihood.shape[1], linear.view(np.int32)
    bits = np.empty(n, np.int32)
    powers, exponents = bits.view(np.float32), np.empty(n, np.float32)
    near, ahead = np.empty(n, np.float32), 0.0
    for k in range(users.shape[0]):
        if k % AHEAD == 0:
            ahead += _touched(log_beliefs, users, k)
        row, new, out = log_beliefs[users[k]], log_likelihood[k], linear[k]
        top = _joined(row, new)
        explained = top > -np.inf
        if not explained:
            for i in range(n):
                new[i] = row[i]
            top = 0.0
        for i in range(n):
            near[i] = new[i] - top
        _exponentials(near, out, bits, powers)
        total = _total(out)
        shift, share = math.log(total), np.float32(stay / total)
        log_evidence[k] = top + shift if explained else -np.inf
        for i in range(n):
            out[i] = out[i] * share + anew[i]
        _logarithms(linear_bits[k], bits, powers, exponents, row)
        if any_small:
            _write_small(row, near, shift, terms)
    return ahead
