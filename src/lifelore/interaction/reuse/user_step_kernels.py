"""Compiled kernel: Bayes' rule for users whose types change by a hazard and whose models are uncertain.

    F(σ | τ, π) = (1 − w_τ) F(σ | τ, π, all signals so far) + w_τ F(σ | τ, π)
    β'(τ) ∝ F(σ | τ, π) β(τ),  then  β' ← (1 − h) β' + h G₀

w_τ is the probability that a user who is now of type τ has just changed to it; the same step as `task_step`.
"""

import math

import numpy as np

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.core.compiled.vector_log import plain_exp, plain_log, plain_log1p
from lifelore.interaction.beliefs.bayes_rule import LOWEST
from lifelore.interaction.reuse.user_kernels import _total

LEAST = 1e-290
"""Beliefs below this are computed by their logarithms."""
FAR = -1e300


@inlined
def _largest(row):
    """The largest number of a row, four at a time."""
    b0, b1, b2, b3 = -np.inf, -np.inf, -np.inf, -np.inf
    n = row.shape[0]
    fours = n - n % 4
    for i in range(0, fours, 4):
        b0, b1 = max(b0, row[i]), max(b1, row[i + 1])
        b2, b3 = max(b2, row[i + 2]), max(b3, row[i + 3])
    for i in range(fours, n):
        b0 = max(b0, row[i])
    return max(max(b0, b1), max(b2, b3))


@kernel
def changing_users(log_beliefs, users, shown, new, log_stay, log_anew, log_evidence, keeps):
    """Update the rows of `users` (k,) among (n_users, n_types) float32 or float64, in place.

    shown : (k, n_types) float64, log likelihoods given what each user has shown; overwritten
    new : (k, n_types) float64, of a user who has shown nothing; overwritten
    log_stay : float, log(1 − h)
    log_anew : (n_types,) float64, log(h G₀)
    log_evidence : (k,) float64, written; -inf where no type explains the signal
    keeps : (k,) float64, written: how much of what the user has shown still counts; NaN where no type explains
        the signal
    """
    n = log_beliefs.shape[1]
    share, joint, out = np.empty(n), np.empty(n), np.empty(n)
    for k in range(users.shape[0]):
        row, old, fresh = log_beliefs[users[k]], shown[k], new[k]
        for i in range(n):
            joint[i] = float(row[i])
        for i in range(n):
            share[i] = plain_exp(min(log_anew[i] - max(joint[i], FAR), 0.0))
        for i in range(n):
            # With a density of 0 all differences are taken from a number that is far below.
            a, b = max(old[i], FAR), max(fresh[i], FAR)
            fresh[i] = max(a, b)
            # Only the smaller density needs an exponential: the larger counts as 1.
            less = plain_exp(-abs(a - b))
            out[i] = (1.0 - share[i]) * (1.0 if a >= b else less)
            share[i] *= less if a >= b else 1.0
        for i in range(n):
            mixed = max(out[i] + share[i], LEAST)
            share[i] = np.divide(share[i], mixed)
            out[i] = fresh[i] + plain_log(mixed)
        for i in range(n):
            old[i] = out[i] if fresh[i] > FAR and joint[i] > -np.inf else -np.inf
        best = _largest(old)
        explained = best > -np.inf
        if explained:
            for i in range(n):
                joint[i] += old[i] - best
        top = _largest(joint)
        for i in range(n):
            out[i] = plain_exp(max(joint[i] - top, FAR))
        total = _total(out)
        for i in range(n):
            share[i] *= out[i]
        changes = _total(share)
        shift = math.log(total)
        log_evidence[k] = max(top + shift + best, LOWEST) if explained else -np.inf
        keeps[k] = 1.0 - min(changes / total, 1.0) if explained else np.nan
        for i in range(n):
            stays = joint[i] - top - shift + log_stay
            high, low = max(stays, log_anew[i]), min(stays, log_anew[i])
            fresh[i] = min(high + plain_log1p(plain_exp(max(low, FAR) - max(high, FAR))), 0.0)
        for i in range(n):
            row[i] = fresh[i]
