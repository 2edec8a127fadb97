"""The support of a belief: the fewest types that hold a given share of it.

Rules that look ahead score a belief by its support alone. A fixed number of types would not do: early beliefs are
flat, and the ten likeliest of 68 types may hold a third of the mass. Rules restricted to these lost 40 % of their
performance. Later a few types hold nearly the whole mass.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.compiler_start import kernel_pays
from lifelore.core.errors import InputError

Array = NDArray[np.float64]

MASS = 1 - 1e-3
"""Default share of the belief that rules which look ahead use; a smaller share is faster and less exact."""


def supported_types(belief: Array, mass: float) -> tuple[NDArray[np.int64], Array]:
    """The fewest types that hold `mass` of a belief (n_types,), and their shares, which sum to 1.

    Types exactly as likely as the last of these are included. Types of belief 0 never are.
    """
    if belief.min() > 2.0 * (1.0 - mass):
        # Even the least likely type holds more than may be left out, with a margin for rounding of the sum.
        return np.arange(len(belief)), belief
    support = np.flatnonzero(belief >= least_kept(belief[None], mass))
    if len(support) == len(belief):
        return support, belief
    share = belief[support]
    return support, share / share.sum()


def truncated(belief: Array, mass: float) -> Array:
    """Beliefs (n, n_types) with all but the supported types at 0, rows summing to 1."""
    support = np.where(belief >= least_kept(belief, mass)[:, None], belief, 0.0)
    return support / support.sum(axis=1, keepdims=True)


def check_mass(mass: float) -> None:
    """Raise InputError where a share of the belief lies outside (0, 1]."""
    if not 0 < mass <= 1:
        raise InputError(f"mass must lie in (0, 1], got {mass}")


def least_kept(belief: Array, mass: float) -> Array:
    """The least belief among the likeliest types that together hold `mass` of each belief (n, n_types), (n,)."""
    if kernel_pays(belief.size):
        from lifelore.interaction.selection import information_kernels

        least = np.empty(len(belief))
        information_kernels.least_kept(belief, mass, least)
        return least
    return np.array([rising_least(row, mass) for row in belief])


def rising_least(belief: Array, mass: float) -> float:
    """The NumPy twin of `information_kernels.least_kept`, for one belief (n_types,)."""
    rising = np.sort(belief)
    held = np.add.accumulate(rising)
    # From below: the types left out may not exceed 1 - mass, and small numbers are summed first.
    last = np.flatnonzero((rising > 0) & (held > (1.0 - mass) * held[-1]))
    return float(rising[last[0]] if len(last) else rising[-1])
