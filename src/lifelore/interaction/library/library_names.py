"""Checks of a library's prior and of the names of its types and policies."""

from collections.abc import Sequence
from itertools import count

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError

Array = NDArray[np.float64]


def checked_prior(prior: ArrayLike | None, n_types: int) -> Array:
    """A distribution over types, (n_types,), uniform where None; InputError where it is no distribution."""
    if prior is None:
        return np.full(n_types, 1 / n_types)
    prior = np.array(prior, np.float64)
    if prior.shape != (n_types,):
        raise InputError(f"prior must be ({n_types},), one number a type, got {prior.shape}")
    if not ((prior >= 0).all() and abs(prior.sum() - 1) <= 1e-9):
        raise InputError(f"prior must be at least 0 and sum to 1, its sum is {prior.sum()}; divide it by its sum")
    return prior


def distinct_names(names: Sequence[str], n: int, what: str) -> tuple[str, ...]:
    """Names of n types or policies, numbered by default; InputError where they are not distinct."""
    names = tuple(str(name) for name in names) or tuple(f"{what} {i}" for i in range(n))
    if len(names) != n or len(set(names)) != n:
        raise InputError(f"there must be {n} distinct names of {what}, got {len(set(names))} in {len(names)}")
    return names


def new_name(name: str | None, taken: Sequence[str], what: str) -> str:
    """The given name of a new type or policy, or a name that is not taken."""
    numbered = (f"{what} {number}" for number in count(len(taken)))
    return name if name is not None else next(free for free in numbered if free not in taken)


def index_of(wanted: str | int, names: Sequence[str], what: str) -> int:
    """The number of a type or policy, by name or number; NotFoundError where it is unknown."""
    if isinstance(wanted, str) and wanted in names:
        return names.index(wanted)
    if isinstance(wanted, int | np.integer) and 0 <= wanted < len(names):
        return int(wanted)
    raise NotFoundError(f"unknown {what} {wanted!r}; there are {len(names)}: {', '.join(names[:10])}")
