"""`@kernel`: compile with Numba, cached on disk, and never a stale result.

Numba's own cache looks at the file of the decorated function alone: when a *called* function in another
file changes, the old machine code answers silently. Here the cache folder's name carries a hash of every
source file that may hold kernels, so any edit or upgrade starts a fresh folder. Every kernel also runs as
plain Python under ``NUMBA_DISABLE_JIT=1``.
"""

import hashlib
import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TypeVar

import numba
from platformdirs import user_cache_dir

F = TypeVar("F", bound=Callable)


@cache
def kernel_cache_dir() -> Path:
    """Folder of the compiled kernels: ``NUMBA_CACHE_DIR`` or the user's cache, then a hash of the sources."""
    package = Path(__file__).parents[1]
    digest = hashlib.sha256(numba.__version__.encode())
    for path in sorted(package.rglob("*.py")):
        source = path.read_bytes()
        if b"@kernel" in source or b"@inlined" in source:
            digest.update(path.relative_to(package).as_posix().encode())
            digest.update(source)
    base = os.environ.get("NUMBA_CACHE_DIR") or user_cache_dir("lifelore")
    return Path(base) / f"kernels-{digest.hexdigest()[:16]}"


def kernel(function: F) -> F:
    """Compile `function` on first call (nogil, no fastmath), keep the machine code between processes."""
    return _compiled(function)


def inlined(function: F) -> F:
    """As `kernel`, for the small pieces that kernels call at every step: always inlined into them."""
    return _compiled(function, forceinline=True)


def _compiled(function: F, **options) -> F:
    previous = numba.config.CACHE_DIR  # type: ignore[attr-defined]
    numba.config.CACHE_DIR = str(kernel_cache_dir())  # type: ignore[attr-defined]
    try:
        return numba.njit(cache=True, nogil=True, **options)(function)  # type: ignore[return-value]
    finally:
        numba.config.CACHE_DIR = previous  # type: ignore[attr-defined]
