"""Compiled kernels: Bayes' rule for rows of log beliefs, in three passes: the largest, the sum, normalisation."""

import math

import numpy as np

from lifelore.core.compiled.jit import inlined, kernel
from lifelore.interaction.beliefs.bayes_rule import LOWEST


@inlined
def _joint(log_belief, log_likelihood, best):
    """Sum of log belief and log likelihood; minus infinity for impossible types, whatever their likelihood."""
    if log_belief == -np.inf:
        return -np.inf
    return float(log_belief) + (float(log_likelihood) - best)


@kernel
def bayes_row(log_belief, log_likelihood):
    """Update a belief (n_types,) in place; returns the log evidence.

    Minus infinity: no type explains the signal, and the belief stays. NaN: a likelihood is NaN or infinite, and
    the belief stays.
    """
    n = log_belief.shape[0]
    # Likelihoods are taken relative to the best of the possible types, so that no sum leaves the range of numbers.
    best = -np.inf
    total = 0.0
    for i in range(n):
        value = float(log_likelihood[i])
        if not value < np.inf:
            return np.nan
        if value > best and log_belief[i] > -np.inf:
            best = value
    if best == -np.inf:
        return -np.inf
    top = -np.inf
    for i in range(n):
        top = max(top, _joint(log_belief[i], log_likelihood[i], best))
    for i in range(n):
        total += math.exp(_joint(log_belief[i], log_likelihood[i], best) - top)
    shift = math.log(total)
    for i in range(n):
        # The largest is taken off first, for beside a large number the logarithm of the sum would be rounded away.
        # A type of belief 1 stays at 0 and not a rounding above it.
        log_belief[i] = min((_joint(log_belief[i], log_likelihood[i], best) - top) - shift, 0.0)
    return max(top + shift + best, LOWEST)


@kernel
def normal_row(log_belief, policy, value, mean, precision, log_height, log_likelihood):
    """`bayes_row` for a number under normals: one call, because two would take twice as long.

    mean, precision, log_height : (n_policies, n_types), see `Normals`
    log_likelihood : (n_types,) float64, written
    """
    for i in range(log_likelihood.shape[0]):
        z = (value - mean[policy, i]) * precision[policy, i]
        log_likelihood[i] = z * z * -0.5 + log_height[policy, i]
    return bayes_row(log_belief, log_likelihood)


@kernel
def bayes_rows(log_beliefs, log_likelihoods, log_evidence):
    """`bayes_row` for rows (n, n_types), evidence into (n,)."""
    for k in range(log_beliefs.shape[0]):
        log_evidence[k] = bayes_row(log_beliefs[k], log_likelihoods[k])


@kernel
def bayes_users(log_beliefs, users, log_likelihoods, log_evidence):
    """`bayes_row` for the rows of `users` (k,) among (n_users, n_types), in order: a user may come twice."""
    for k in range(users.shape[0]):
        log_evidence[k] = bayes_row(log_beliefs[users[k]], log_likelihoods[k])
