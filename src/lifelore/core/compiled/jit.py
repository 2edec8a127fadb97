"""`@kernel`: compile a function with Numba and cache it on disk; an edited source is compiled again.

The cache folders are those of `core.kernel_cache`. Every kernel also runs as plain Python under
``NUMBA_DISABLE_JIT=1``.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba
import numpy as np

from lifelore.core.compiled.kernel_cache import kernel_folder

F = TypeVar("F", bound=Callable)
_config: Any = numba.config  # type: ignore[attr-defined]
_njit: Any = numba.njit


def kernel(function: F) -> F:
    """Compile a function on its first call (nogil, no fastmath) and store the machine code for later processes."""
    return _compiled(function)


def inlined(function: F) -> F:
    """As `kernel`, for small functions that kernels call at every step: always inlined."""
    return _compiled(function, inline="always")


def _compiled(function: F, **options: Any) -> F:
    if _config.DISABLE_JIT:
        # Sums of random states wrap around, as in machine code, on any thread.
        return np.errstate(over="ignore")(function)
    folder = kernel_folder(Path(function.__code__.co_filename))
    previous = _config.CACHE_DIR
    _config.CACHE_DIR = str(folder)
    try:
        return _njit(nogil=True, cache=folder is not None, **options)(function)
    finally:
        _config.CACHE_DIR = previous
