"""Random streams derived from names, so that adding a stream never changes another."""

import hashlib
from numbers import Integral

import numpy as np

from lifelore.core.errors import InputError


def stream(seed: int | np.random.Generator, *names: str | int) -> np.random.Generator:
    """A generator that depends on `seed` and `names` alone.

    Parameters
    ----------
    seed : int or numpy generator
        Any integer; the ``--seed`` of a run. A generator is returned as it is.
    *names : str or int
        Purpose of the numbers, e.g. ``stream(7, "task", 3, "starts")``.

    Raises
    ------
    InputError
        The seed is neither.

    Examples
    --------
    >>> float(stream(7, "task", 3).random()) == float(stream(7, "task", 3).random())
    True
    >>> float(stream(7, "task", 3).random()) == float(stream(7, "task", 4).random())
    False
    """
    if isinstance(seed, np.random.Generator):
        return seed
    if not isinstance(seed, Integral):
        raise InputError(f"seed must be a whole number or a numpy generator, got {seed!r:.60}")
    label = "\x1f".join(_label(name) for name in (int(seed), *names))
    digest = hashlib.sha256(label.encode()).digest()
    return np.random.default_rng(np.frombuffer(digest, dtype=np.uint32))


def _label(name: str | int) -> str:
    # A NumPy integer names the same stream as the Python one.
    return f"int:{int(name)}" if isinstance(name, Integral) else f"{type(name).__name__}:{name}"
