"""Beliefs cut down to the types that matter: by the mass they hold, never by their number.

Early beliefs are flat: the ten likeliest of 68 types may hold a third of the mass, and rules that look at
these alone lose 40 % of their worth. Later a few types hold nearly all.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.compiler_start import kernel_pays
from lifelore.core.errors import InputError

Array = NDArray[np.float64]

MASS = 1 - 1e-3
"""Share of the belief that rules which look ahead keep unless told otherwise."""


def supported_types(belief: Array, mass: float) -> tuple[NDArray[np.int64], Array]:
    """The fewest types that hold `mass` of a belief (n_types,), and their shares, which sum to 1.

    Types exactly as likely as the last one taken are taken too; types of belief 0 never are.
    """
    kept = np.flatnonzero(belief >= least_kept(belief, mass))
    if len(kept) == len(belief):
        return kept, belief
    share = belief[kept]
    return kept, share / share.sum()


def truncated(belief: Array, mass: float) -> Array:
    """Beliefs (n, n_types) with all but the supported types at 0, rows summing to 1."""
    least = np.array([least_kept(row, mass) for row in belief])
    kept = np.where(belief >= least[:, None], belief, 0.0)
    return kept / kept.sum(axis=1, keepdims=True)


def check_mass(mass: float) -> None:
    """Refuse a share of the belief outside (0, 1]."""
    if not 0 < mass <= 1:
        raise InputError(f"mass must lie in (0, 1], got {mass}")


def least_kept(belief: Array, mass: float) -> float:
    """The belief of the last type taken, in the order of belief, before `mass` of the whole is held."""
    if kernel_pays(belief.size):
        from lifelore.interaction.selection import support_kernels

        return support_kernels.least_kept(belief, mass)
    return rising_least(belief, mass)


def rising_least(belief: Array, mass: float) -> float:
    """The NumPy twin of `support_kernels.least_kept`."""
    rising = np.sort(belief)
    held = np.add.accumulate(rising)
    # From below: what is left out may not exceed 1 - mass, and small numbers are summed first.
    last = np.flatnonzero((rising > 0) & (held > (1.0 - mass) * held[-1]))
    return float(rising[last[0]] if len(last) else rising[-1])
