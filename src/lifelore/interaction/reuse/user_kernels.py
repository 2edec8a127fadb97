"""Compiled kernels for float32 beliefs of many users: Bayes' rule, reading beliefs, drawing types.

Rows are logs of beliefs. Each kernel handles the users of one block, whose linear beliefs stay in the cache
between two kernels. float32 rows have an exponential of their own. It has no branches, so it handles sixteen
types at a time. It is exact to 2e-7 relative, and 0 below e^-87, so it makes no subnormal numbers.
"""

import math

import numpy as np

from lifelore.core.compiled.jit import inlined, kernel

LEAST_LOG = -87.0
"""Logs of float32 beliefs below this count as 0 when beliefs are read; the stored logs stay."""

AHEAD, LINE = 32, 16
"""Number of rows loaded ahead, and float32 numbers in a line of the cache."""

_LOG2_E = np.float32(1.4426950408889634)
# ln 2 in two parts, the first with few digits, so that n ln 2 is exact.
_LN2_HIGH, _LN2_LOW = np.float32(0.693359375), np.float32(-2.12194440e-4)
_C2, _C3, _C4 = np.float32(0.5), np.float32(1.6666665459e-1), np.float32(4.1665795894e-2)
_C5, _C6, _C7 = np.float32(8.3334519073e-3), np.float32(1.3981999507e-3), np.float32(1.9875691500e-4)
_ONE = np.float32(1.0)
_LOWEST = np.float32(LEAST_LOG)
_BIAS, _SHIFT = np.int32(127), np.int32(23)


@inlined
def _exponentials(logs, linear, bits, powers):
    """linear = exp(logs) of a float32 row, at most 0; `powers` is `bits` seen as float32."""
    zero = np.float32(0.0)
    n = logs.shape[0]
    for i in range(n):
        x = max(logs[i], _LOWEST)
        whole = np.rint(x * _LOG2_E)
        r = x - whole * _LN2_HIGH - whole * _LN2_LOW
        high = ((_C7 * r + _C6) * r + _C5) * r + _C4
        linear[i] = ((high * r + _C3) * r + _C2) * (r * r) + r + _ONE
        bits[i] = (np.int32(whole) + _BIAS) << _SHIFT
    for i in range(n):
        value = linear[i] * powers[i]
        linear[i] = value if logs[i] > _LOWEST else zero


@inlined
def _joined(row, new):
    """new = row + new in place; returns the largest, found four at a time."""
    b0, b1, b2, b3 = -np.inf, -np.inf, -np.inf, -np.inf
    n = row.shape[0]
    fours = n - n % 4
    for i in range(n):
        new[i] = row[i] + new[i]
    for i in range(0, fours, 4):
        b0 = max(b0, new[i])
        b1 = max(b1, new[i + 1])
        b2 = max(b2, new[i + 2])
        b3 = max(b3, new[i + 3])
    for i in range(fours, n):
        b0 = max(b0, new[i])
    return max(max(b0, b1), max(b2, b3))


@inlined
def _total(row):
    """The sum of a row, four at a time."""
    s0, s1, s2, s3 = 0.0, 0.0, 0.0, 0.0
    n = row.shape[0]
    fours = n - n % 4
    for i in range(0, fours, 4):
        s0 += row[i]
        s1 += row[i + 1]
        s2 += row[i + 2]
        s3 += row[i + 3]
    for i in range(fours, n):
        s0 += row[i]
    return (s0 + s1) + (s2 + s3)


@inlined
def _touched(log_beliefs, users, first):
    """Load the rows of the next users all at once: memory serves many requests in the time of a single request."""
    total = 0.0
    for k in range(first, min(first + AHEAD, users.shape[0])):
        row = log_beliefs[users[k]]
        for i in range(0, row.shape[0], LINE):
            total += row[i]
    return total


@kernel
def bayes_users_f4(log_beliefs, users, log_likelihood, linear, log_evidence):
    """Bayes' rule for the rows of `users`, in place and in order: a user may come twice.

    log_beliefs : (n_users, n_types) float32, normalised logs, written
    users : (k,) int64
    log_likelihood : (k, n_types) float64, below infinity; overwritten
    linear : (k, n_types) float32, the beliefs afterwards, written
    log_evidence : (k,) float64, written; -inf where no type explains the signal, whose user's belief stays

    Sums of logs are taken in float64 until the largest is known. Returns a number without meaning, made of the
    rows that are loaded ahead.
    """
    n = log_likelihood.shape[1]
    bits = np.empty(n, np.int32)
    powers = bits.view(np.float32)
    near = np.empty(n, np.float32)
    zero, ahead = np.float32(0.0), 0.0
    for k in range(users.shape[0]):
        if k % AHEAD == 0:
            ahead += _touched(log_beliefs, users, k)
        row, new, out = log_beliefs[users[k]], log_likelihood[k], linear[k]
        # A float32 log belief is too small a number to take a likelihood out of the range of float64.
        top = _joined(row, new)
        if top == -np.inf:
            _exponentials(row, out, bits, powers)
            log_evidence[k] = -np.inf
            continue
        for i in range(n):
            near[i] = new[i] - top
        _exponentials(near, out, bits, powers)
        total = _total(out)
        log_evidence[k] = top + math.log(total)
        shift, share = np.float32(math.log(total)), np.float32(1.0 / total)
        for i in range(n):
            row[i] = min(near[i] - shift, zero)
            out[i] *= share
    return ahead


@kernel
def read_f4(log_beliefs, users, linear):
    """Beliefs of `users` from float32 logs, (k, n_types) float32, rows sum to 1; returns as `bayes_users_f4`."""
    n = log_beliefs.shape[1]
    bits = np.empty(n, np.int32)
    powers = bits.view(np.float32)
    ahead = 0.0
    for k in range(users.shape[0]):
        if k % AHEAD == 0:
            ahead += _touched(log_beliefs, users, k)
        out = linear[k]
        _exponentials(log_beliefs[users[k]], out, bits, powers)
        share = np.float32(1.0 / _total(out))
        for i in range(n):
            out[i] *= share
    return ahead


@kernel
def draw_types(linear, uniforms, drawn):
    """Draw a type for each row of beliefs (k, n_types) by `uniforms` (k,) in [0, 1); never a type of belief 0."""
    n = linear.shape[1]
    for k in range(linear.shape[0]):
        row = linear[k]
        left = uniforms[k] * _total(row)
        last = 0
        for i in range(n):
            share = row[i]
            if share > 0:
                last = i
                left -= share
                if left < 0:
                    break
        drawn[k] = last
