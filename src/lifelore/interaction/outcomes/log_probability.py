"""Checks of probability arrays, their logarithms, and probabilities from counts."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.pseudo_counts import PseudoCount, checked_pseudo_count

Array = NDArray[np.float64]


def checked_distributions(probs: ArrayLike, name: str, axes: tuple[str, ...]) -> Array:
    """A float64 copy whose rows along the last axis are distributions to 1e-6.

    Raises
    ------
    InputError
        The number of axes differs, one is empty, or a row is no distribution.
    """
    try:
        probs = np.array(probs, np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name} must be numbers ({', '.join(axes)}), rows of one length") from None
    if probs.ndim != len(axes) or not probs.size:
        raise InputError(f"{name} must be ({', '.join(axes)}) numbers, none of them 0, got {probs.shape}")
    if not ((probs >= 0).all() and (np.abs(probs.sum(axis=-1) - 1) <= 1e-6).all()):
        raise InputError(f"{name} must be at least 0 and sum to 1 along {axes[-1]}; divide each row by its sum")
    return probs


def log_of(probs: Array) -> Array:
    """Logarithms, -inf where a probability is 0."""
    return np.log(probs, out=np.full_like(probs, -np.inf), where=probs > 0)


def checked_weight(count: float | None) -> float:
    """The factor that turns a row of probabilities into counts: `count`, or 1 where it is exact."""
    if count is None:
        return 1.0
    if not (count > 0 and np.isfinite(count)):
        raise InputError(f"count must be positive and finite, got {count}; omit it where the numbers are exact")
    return float(count)


def with_pseudo_counts(counts: ArrayLike, pseudo_count: PseudoCount) -> Array:
    """Distributions along the last axis from counts, `pseudo_count` added to each; uniform where all are 0.

    Raises
    ------
    InputError
        A count is negative or not finite, or the pseudo-count negative.
    """
    counts = np.asarray(counts, np.float64)
    if not counts.size or not ((counts >= 0).all() and np.isfinite(counts).all()):
        raise InputError("counts must be at least 0 and finite, at least one of them")
    weights = counts + checked_pseudo_count(pseudo_count, counts)
    totals = weights.sum(axis=-1, keepdims=True)
    return np.divide(weights, totals, out=np.full_like(weights, 1 / counts.shape[-1]), where=totals > 0)
