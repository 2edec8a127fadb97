"""Checks of probability arrays and of the counts behind them, and logarithms of probabilities."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.outcome_rows import numbers, of_shape

Array = NDArray[np.float64]


def checked_distributions(probs: ArrayLike, name: str, axes: tuple[str, ...]) -> Array:
    """A float64 copy whose rows along the last axis are distributions to 1e-6.

    Raises
    ------
    InputError
        The number of axes differs, one is empty, or a row is no distribution.
    """
    probs = numbers(probs, f"{name} must be numbers ({', '.join(axes)}), rows of one length").copy()
    if probs.ndim != len(axes) or not probs.size:
        raise InputError(f"{name} must be ({', '.join(axes)}) numbers, none of them 0, got {probs.shape}")
    if not ((probs >= 0).all() and (np.abs(probs.sum(axis=-1) - 1) <= 1e-6).all()):
        raise InputError(f"{name} must be at least 0 and sum to 1 along {axes[-1]}; divide each row by its sum")
    return probs


def log_of(probs: Array) -> Array:
    """Logarithms, -inf where a probability is 0."""
    return np.log(probs, out=np.full_like(probs, -np.inf), where=probs > 0)


def normalised(logs: Array) -> tuple[Array, Array]:
    """The distributions of log weights (n, k), each row with a finite one, and the log of each row's sum, (n,)."""
    top = logs.max(axis=1, keepdims=True)
    weights = np.exp(logs - top)
    total = weights.sum(axis=1, keepdims=True)
    return weights / total, (np.log(total) + top)[:, 0]


def checked_pseudo_count(pseudo_count: float) -> float:
    """The weight added to each cell; InputError where it is no number, negative or not finite."""
    if isinstance(pseudo_count, str) or not 0 <= pseudo_count < np.inf:
        raise InputError(f"pseudo_count must be at least 0 and finite, got {pseudo_count!r}")
    return pseudo_count


def checked_counts(count: ArrayLike, shape: tuple[int, ...]) -> Array:
    """The number of samples behind each row of probabilities, a number or of `shape`, as a float64 of `shape`.

    Raises
    ------
    InputError
        It has another shape, or is not positive and finite.
    """
    found = of_shape(count, shape, "count")
    if not ((found > 0) & np.isfinite(found)).all():
        raise InputError(f"count must be positive and finite, got {count!r:.80}; omit it for exact probabilities")
    return found
