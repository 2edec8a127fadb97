"""Truncation of a belief to its support: the fewest types that hold a given share of it.

Rules that look ahead score a belief by its support alone. A fixed number of types would not do: early beliefs are
flat, and the ten likeliest of 68 types may hold a third of the mass. Rules restricted to these lost 40 % of their
performance. Later a few types hold nearly the whole mass.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError

Array = NDArray[np.float64]

MASS = 1 - 1e-3
"""Default share of the belief that rules which look ahead use; a smaller share is faster and less exact."""


def truncated(belief: Array, mass: float) -> Array:
    """The belief (..., T) with 0 for all but the fewest types that hold `mass` of it; rows sum to 1.

    Types exactly as likely as the last of these are included. Types of belief 0 never are.
    """
    rising = belief.copy()
    rising.sort(axis=-1)
    held = np.add.accumulate(rising, axis=-1)
    # From below: the types left out may not exceed 1 - mass, and small numbers are summed first.
    first = (held > (1.0 - mass) * held[..., -1:]).argmax(axis=-1)
    least = rising[first] if belief.ndim == 1 else np.take_along_axis(rising, first[..., None], axis=-1)
    kept = belief * (belief >= least)
    return kept / np.add.reduce(kept, axis=-1, keepdims=True)


def check_mass(mass: float) -> None:
    """Raise InputError where a share of the belief lies outside (0, 1]."""
    if not 0 < mass <= 1:
        raise InputError(f"mass must lie in (0, 1], got {mass}")
