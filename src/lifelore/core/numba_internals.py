"""What this package uses of Numba that Numba does not document, behind one function, with a way to do without."""

import os
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numba

from lifelore.core.kernel_cache import PACKAGE, kernel_cache_dir

NO_COUNTING = {"_nrt": False}
"""Options of `numba.njit` for a kernel that counts no references."""


class Internals(NamedTuple):
    """Numba's undocumented parts.

    quick_cache : callable, a kernel's cache on disk of its function; loading fills no registries
    no_counting : dict, options of `numba.njit` by which a kernel counts no references
    """

    quick_cache: Callable[[Callable], Any]
    no_counting: dict[str, Any]


@cache
def internals() -> Internals | None:
    """Numba's undocumented parts, or None where this release has others: everything then works, but slower.

    Loading a kernel from Numba's own cache fills all registries (0.6 s), which only compiling needs. A test fails
    as soon as a release of Numba makes this return None.
    """
    try:
        found = Internals(_quick_cache_class(), NO_COUNTING)
        found.quick_cache(_nothing)
        _njit(no_cfunc_wrapper=True, **found.no_counting)(_nothing)
    except (ImportError, AttributeError, TypeError, KeyError):
        return None
    return found


_njit: Any = numba.njit


def _nothing() -> None:
    """A kernel to try Numba with."""


def _quick_cache_class() -> Any:
    from numba.core import caching, runtime

    parent: Any = caching.FunctionCache
    locator: Any = caching._CacheLocator

    class Locator(locator):
        """Finds a kernel's machine code by the kernel's place in the package."""

        def __init__(self, function: Callable) -> None:
            room = Path(function.__code__.co_filename).relative_to(PACKAGE).parent
            self._path = str(kernel_cache_dir() / room)
            self._line = str(function.__code__.co_firstlineno)

        @classmethod
        def from_function(cls, function: Callable, _file: str) -> "Locator":
            return cls(function)

        def get_cache_path(self) -> str:
            return self._path

        def ensure_cache_path(self) -> None:
            os.makedirs(self._path, exist_ok=True)

        def get_source_stamp(self) -> int:
            return 0  # the folder's name says which sources

        def get_disambiguator(self) -> str:
            return self._line

    class Implementation(caching.CompileResultCacheImpl):
        _locator_classes = (Locator,)

    class QuickCache(parent):
        """Loads machine code without filling Numba's registries."""

        _impl_class = Implementation

        def load_overload(self, sig: Any, target_context: Any) -> Any:
            runtime.rtsys.initialize(target_context)  # type: ignore[attr-defined]
            try:
                return self._load_overload(sig, target_context)
            except OSError:
                return None

        def save_overload(self, sig: Any, data: Any) -> None:
            # Where nothing can be written each process compiles for itself; `lifelore doctor` says so.
            with suppress(OSError):
                super().save_overload(sig, data)

    return QuickCache
