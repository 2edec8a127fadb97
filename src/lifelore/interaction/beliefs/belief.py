"""Beliefs over types in log space: the prior, and Bayes' rule for any number of users.

    β'(τ) = F(σ | τ, π) β(τ) / Σ F(σ | τ', π) β(τ')                                            Eq. 4.1, 4.2

A belief of 10⁻⁴⁰⁰ is still a number in log space and may rise again. A belief of 0 stays 0. A signal that no type
explains leaves the belief as it is; its log evidence is minus infinity. Thesis: §4.4.3.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError

Array = NDArray[Any]

FAR = 100.0
"""Largest log likelihood in size that a log belief is added to: beside larger numbers it would be rounded."""
NEAR = 30.0
"""Largest log of a sum in size that is taken of the terms as they are: float32 holds all of them that count."""
SUM_TOLERANCE = 1e-9
"""Largest distance from 1 of the sum of a caller's belief."""


class Updated(NamedTuple):
    """A belief after a signal.

    log_belief : (..., n_types) float, normalised
    log_evidence : (...) float, log Σ F β; minus infinity where no type explains the signal
    """

    log_belief: Array
    log_evidence: Array


def log_prior(prior: ArrayLike) -> NDArray[np.float64]:
    """Logarithms of an initial belief, normalised.

    Parameters
    ----------
    prior : (..., n_types) float
        At least 0, each row summing to 1 to 1e-9.

    Raises
    ------
    InputError
        An entry is negative or NaN, or a row does not sum to 1.

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
        log F(σ | τ, π), below infinity; minus infinity allowed. Not checked here.

    Examples
    --------
    >>> after = update(log_prior([0.5, 0.5]), np.log([0.1, 0.3]))
    >>> np.exp(after.log_belief).round(3).tolist(), float(np.exp(after.log_evidence).round(3))
    ([0.25, 0.75], 0.2)
    """
    log_belief, log_likelihood, best = np.asarray(log_belief), np.asarray(log_likelihood), None
    if log_likelihood.dtype != log_belief.dtype:
        # Of likelihoods in float64, rows in float32 take what is left beside the best.
        best = largest(log_likelihood)
        best = np.where(np.isfinite(best), best, 0.0)
        log_likelihood = (log_likelihood - best).astype(log_belief.dtype)
    joint = log_belief + log_likelihood
    log_evidence = log_sum(joint)
    if (abs(log_evidence) if joint.ndim == 1 else np.abs(log_evidence).max(initial=0.0)) > FAR:
        joint, more = _relative_to_possible(log_belief, log_likelihood)
        log_evidence, best = log_sum(joint), more if best is None else best + more
    joint -= log_evidence if joint.ndim == 1 else log_evidence[..., None]
    return Updated(joint, log_evidence if best is None else log_evidence + best[..., 0])


def _relative_to_possible(log_belief: Array, log_likelihood: Array) -> tuple[Array, Array]:
    """Sums of log beliefs and log likelihoods less the largest likelihood of a possible type, and that likelihood.

    Beside a large likelihood a belief would be rounded away. Where no type explains the signal the likelihood is
    minus infinity, and the belief stays.
    """
    possible = log_belief > -np.inf
    best = np.where(possible, log_likelihood, -np.inf).max(axis=-1, keepdims=True)
    with np.errstate(invalid="ignore", over="ignore"):
        relative = np.where(possible & (best > -np.inf), log_likelihood - best, 0.0)
    return log_belief + relative.astype(log_belief.dtype, copy=False), best


def log_sum(terms: Array) -> Array:
    """log Σ exp over the last axis, (..., n) to (...); minus infinity where all terms are."""
    if terms.ndim == 1:
        # A single row in one call of NumPy, which is slow for many rows.
        return np.logaddexp.reduce(terms)
    # Products with ones: sums over short axes are slow. Not with `@`: for a float32 matrix times a vector OpenBLAS
    # reads unset numbers on AVX-512, and warns of an invalid value where there is none.
    ones = np.ones(terms.shape[-1], terms.dtype)
    with np.errstate(divide="ignore", over="ignore"):
        found = np.log(np.vecdot(np.exp(terms), ones))
        if np.abs(found).max(initial=0.0) < NEAR:
            return found
        top = largest(terms)
        top = np.where(top > -np.inf, top, 0.0)
        return np.log(np.vecdot(np.exp(terms - top), ones)) + top[..., 0]


def largest(rows: Array) -> Array:
    """The largest number of each row (..., n), (..., 1); NaN where one is."""
    # Its place first: NumPy's maximum over a short axis takes three times as long.
    return np.take_along_axis(rows, rows.argmax(axis=-1)[..., None], axis=-1)
