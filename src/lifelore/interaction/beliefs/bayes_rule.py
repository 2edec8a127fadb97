"""Bayes' rule for a single belief in log space, in NumPy: the twin of `belief_kernels.bayes_row`."""

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LOWEST = -1.7e308
"""Smallest log evidence of a possible signal; minus infinity is the log evidence of an impossible signal."""


def bayes_rule(log_belief: Array, log_likelihood: Array) -> tuple[Array, float]:
    """The belief (n_types,) after a signal, and the log evidence; the bits are those of the kernel."""
    if not (log_likelihood < np.inf).all():
        return log_belief, np.nan
    possible = log_belief > -np.inf
    best = max(log_likelihood[possible].tolist(), default=-np.inf)
    if best == -np.inf:
        return log_belief, -np.inf
    joint = np.full(log_belief.shape, -np.inf)
    with np.errstate(over="ignore"):
        joint[possible] = log_belief[possible] + (log_likelihood[possible] - best)
    top = max(joint.tolist())
    # The kernel's own functions and order of sums: NumPy's exponential and its sum may differ in the last bit.
    total = 0.0
    for value in (joint - top).tolist():
        total += math.exp(value)
    shift = math.log(total)
    after = (joint - top) - shift
    return np.where(after > 0, 0.0, after), max(top + shift + best, LOWEST)
