"""Beliefs over types, in log space: exact where likelihoods are zero, and for as many users at once as you like.

    β'(τ) = F(σ | τ, π) β(τ) / Σ F(σ | τ', π) β(τ')                                            Eq. 4.1, 4.2

A belief that reached 10⁻⁴⁰⁰ is still a number here and may rise again; a belief of 0 stays 0. A signal that no
type explains leaves the belief as it is and says so by an evidence of minus infinity. Thesis: §4.4.3.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.compiler_start import kernel_pays

Array = NDArray[np.float64]

LOWEST = -1.7e308
"""Stands for a log evidence below the range of numbers, which is not the evidence of what is impossible."""
ROW_COST = 10
"""Time of `bayes_rule` for each type, in units of `kernel_pays`."""
SUM_TOLERANCE = 1e-9
"""How far from 1 a belief given by a caller may sum."""


class Updated(NamedTuple):
    """A belief after a signal.

    log_belief : (..., n_types) float64, normalised
    log_evidence : (...) float64, log Σ F β; minus infinity where no type explains the signal
    """

    log_belief: Array
    log_evidence: Array


def log_prior(prior: ArrayLike) -> Array:
    """Logs of a belief that starts an agent, normalised to the last bit of rounding.

    Parameters
    ----------
    prior : (..., n_types) float
        At least 0, each row summing to 1 to 1e-9.

    Raises
    ------
    InputError
        An entry is negative or no number, or a row sums to something else.

    Examples
    --------
    >>> log_prior([0.5, 0.5, 0.0]).round(4).tolist()
    [-0.6931, -0.6931, -inf]
    """
    prior = np.asarray(prior, np.float64)
    if not prior.ndim or not prior.size:
        raise InputError(f"prior must have one number for each type, got shape {prior.shape}")
    if not (prior >= 0).all():
        raise InputError("prior must be at least 0 for every type, got a negative entry or NaN")
    total = prior.sum(axis=-1, keepdims=True)
    if not (np.abs(total - 1) <= SUM_TOLERANCE).all():
        raise InputError(f"prior must sum to 1, got {total.ravel()[0]:.9g}; divide it by its sum")
    with np.errstate(divide="ignore"):
        return np.log(prior / total)


def update(log_belief: ArrayLike, log_likelihood: ArrayLike) -> Updated:
    """The belief after a signal; leading axes are users and broadcast against one another.

    Parameters
    ----------
    log_belief : (..., n_types) float
        Normalised logs; minus infinity allowed.
    log_likelihood : (..., n_types) float
        log F(σ | τ, π); minus infinity allowed.

    Raises
    ------
    InputError
        A likelihood is NaN or infinite.

    Examples
    --------
    >>> after = update(log_prior([0.5, 0.5]), np.log([0.1, 0.3]))
    >>> np.exp(after.log_belief).round(3).tolist(), float(np.exp(after.log_evidence).round(3))
    ([0.25, 0.75], 0.2)
    """
    beliefs, likelihoods = np.broadcast_arrays(
        np.asarray(log_belief, np.float64), np.asarray(log_likelihood, np.float64)
    )
    shape = beliefs.shape
    result = np.array(beliefs.reshape(-1, shape[-1]), order="C")
    rows = np.ascontiguousarray(likelihoods.reshape(result.shape))
    evidence = np.empty(len(result))
    if kernel_pays(ROW_COST * result.size):
        from lifelore.interaction.beliefs.belief_kernels import bayes_rows

        bayes_rows(result, rows, evidence)
    else:
        for number, row in enumerate(rows):
            result[number], evidence[number] = bayes_rule(result[number], row)
    if np.isnan(evidence).any():
        raise InputError(
            "log_likelihood must be numbers below infinity (minus infinity is allowed), got NaN or infinity"
        )
    return Updated(result.reshape(shape), evidence.reshape(shape[:-1]))


def bayes_rule(log_belief: Array, log_likelihood: Array) -> tuple[Array, float]:
    """One belief (n_types,) after a signal, and the log evidence: the NumPy twin of `belief_kernels.bayes_row`."""
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


def entropy(belief: ArrayLike) -> Array:
    """Entropy in nats of beliefs (..., n_types), (...); 0 log 0 is 0."""
    belief = np.asarray(belief, np.float64)
    return -(belief * np.log(np.where(belief > 0, belief, 1.0))).sum(axis=-1)


def expected_utility(belief: ArrayLike, mean: ArrayLike) -> Array:
    """Ũ(π) = Σ β(τ) E[U | τ, π] (Eq. 4.5) of beliefs (..., n_types) and means (n_types, n_policies)."""
    return np.asarray(belief, np.float64) @ np.asarray(mean, np.float64)
