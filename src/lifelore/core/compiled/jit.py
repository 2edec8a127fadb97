"""`@kernel`: compile a function with Numba and cache it on disk; a changed source recompiles.

The cache folder is that of `core.kernel_cache`. Every kernel also runs as plain Python under
``NUMBA_DISABLE_JIT=1``.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, overload

import numba

from lifelore.core.compiled.kernel_cache import PACKAGE, kernel_cache_dir
from lifelore.core.compiled.numba_internals import NO_COUNTING, quick_cache

F = TypeVar("F", bound=Callable)
_config: Any = numba.config  # type: ignore[attr-defined]
_njit: Any = numba.njit


@overload
def kernel(function: F) -> F: ...
@overload
def kernel(*, allocates: bool) -> Callable[[F], F]: ...
def kernel(function=None, *, allocates: bool = True):
    """Compile a function on its first call (nogil, no fastmath) and keep the machine code between processes.

    Parameters
    ----------
    function : callable
    allocates : bool
        False: the kernel makes no array, nor does any function that it calls. Numba then counts no references,
        whose atomic instructions cost up to two thirds of a learner's step. A kernel that makes an array after all
        does not compile.

    Returns
    -------
    callable
        The compiled function; without arguments in parentheses the decorator itself.
    """
    options = NO_COUNTING if not (allocates or _config.DISABLE_JIT) and quick_cache() else {}
    if function is None:
        return lambda decorated: _compiled(decorated, options)
    return _compiled(function, options)


def inlined(function: F) -> F:
    """As `kernel`, for small functions that kernels call at every step: always inlined."""
    return _compiled(function, {"inline": "always"})


def _compiled(function: F, options: dict[str, Any]) -> F:
    if _config.DISABLE_JIT:
        return function
    found, settings = quick_cache(), dict(nogil=True, no_cfunc_wrapper=True, **options)
    # The hash in the folder's name covers this package alone; elsewhere Numba's own cache looks at the file.
    if found and PACKAGE in Path(function.__code__.co_filename).parents:
        dispatcher: Any = _njit(**settings)(function)
        dispatcher._cache = found(function)
        return dispatcher
    previous = _config.CACHE_DIR
    _config.CACHE_DIR = str(kernel_cache_dir())
    try:
        return _njit(cache=True, **settings)(function)
    finally:
        _config.CACHE_DIR = previous
