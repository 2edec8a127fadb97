"""Compiled kernels: Bayes' rule and the step of a hazard in a single pass, for rows of float64 log beliefs."""

import math

import numpy as np

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.interaction.beliefs.bayes_rule import LOWEST
from lifelore.interaction.beliefs.hazard import (
    ABOVE,
    BIAS,
    EXPONENT_AT,
    L1,
    L2,
    L3,
    L4,
    L5,
    L6,
    L7,
    LEAST_ANEW,
    LN2_HIGH,
    LN2_LOW,
    MANTISSA,
    ROOT_HALF,
)

LEAST = LEAST_ANEW["f8"]


@inlined
def log_of_sum(a, b):
    """log(exp a + exp b)."""
    high, low = max(a, b), min(a, b)
    return high if low == -np.inf else high + math.log1p(math.exp(low - high))


@inlined
def _logarithms(bits, powers, exponents, out):
    """out = min(log(powers), 0); `powers` is `bits` seen as float64, both overwritten. Loops without branches."""
    n = out.shape[0]
    for i in range(n):
        moved = bits[i] + ABOVE
        exponents[i] = float(moved >> EXPONENT_AT) - BIAS
        bits[i] = (moved & MANTISSA) + ROOT_HALF
    for i in range(n):
        k, f = exponents[i], powers[i] - 1.0
        half, s = 0.5 * f * f, np.divide(f, 2.0 + f)
        z = s * s
        w = z * z
        rest = w * (L2 + w * (L4 + w * L6)) + z * (L1 + w * (L3 + w * (L5 + w * L7)))
        out[i] = min(s * (half + rest) + k * LN2_LOW - half + f + k * LN2_HIGH, 0.0)


@inlined
def _hazard_row(row, log_likelihood, terms, bits, powers, exponents):
    """As `hazard_row`, with arrays (n_types,) for intermediate numbers; `powers` is `bits` seen as float64."""
    stay, log_stay, anew, log_anew, small = terms
    n = row.shape[0]
    best, top, total, finite = -np.inf, -np.inf, 0.0, True
    for i in range(n):
        value = float(log_likelihood[i])
        finite = finite and value < np.inf
        if value > best and row[i] > -np.inf:
            best = value
    if not finite:
        return np.nan
    explained = best > -np.inf
    if explained:
        for i in range(n):
            row[i] = row[i] + (float(log_likelihood[i]) - best) if row[i] > -np.inf else -np.inf
    for i in range(n):
        top = max(top, row[i])
    for i in range(n):
        powers[i] = math.exp(row[i] - top)
        total += powers[i]
    shift, share = math.log(total), stay / total
    for j in range(small.shape[0]):
        exponents[j] = log_of_sum(row[small[j]] - top - shift + log_stay, log_anew[small[j]])
    for i in range(n):
        powers[i] = max(powers[i] * share + anew[i], LEAST)
    if small.shape[0]:
        kept = exponents[: small.shape[0]].copy()
        _logarithms(bits, powers, exponents, row)
        for j in range(small.shape[0]):
            row[small[j]] = min(kept[j], 0.0)
    else:
        _logarithms(bits, powers, exponents, row)
    return max(top + shift + best, LOWEST) if explained else -np.inf


@kernel
def hazard_row(log_belief, log_likelihood, terms):
    """Bayes' rule for a belief (n_types,) in place, then the step of the hazard; returns the log evidence.

    terms : HazardTerms
    Minus infinity: no type explains the signal, and the belief takes the step alone. NaN: a likelihood is NaN or
    infinite, and the belief stays.
    """
    n = log_belief.shape[0]
    bits = np.empty(n, np.uint64)
    return _hazard_row(log_belief, log_likelihood, terms, bits, bits.view(np.float64), np.empty(n))


@kernel
def hazard_normal_row(log_belief, policy, value, mean, precision, log_height, log_likelihood, terms):
    """As `normal_row`, then the step of the hazard."""
    for i in range(log_likelihood.shape[0]):
        z = (value - mean[policy, i]) * precision[policy, i]
        log_likelihood[i] = z * z * -0.5 + log_height[policy, i]
    return hazard_row(log_belief, log_likelihood, terms)


@kernel
def hazard_users(log_beliefs, users, log_likelihoods, log_evidence, terms):
    """`hazard_row` for the rows of `users` (k,) among (n_users, n_types), in order: a user may come twice."""
    n = log_beliefs.shape[1]
    bits = np.empty(n, np.uint64)
    powers, exponents = bits.view(np.float64), np.empty(n)
    for k in range(users.shape[0]):
        log_evidence[k] = _hazard_row(log_beliefs[users[k]], log_likelihoods[k], terms, bits, powers, exponents)
