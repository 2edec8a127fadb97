"""`@kernel`: compile with Numba, cached on disk, and never a stale result.

Numba's own cache looks at the file of the decorated function alone: when a *called* function in another
file changes, or a constant that it reads, the old machine code answers silently. Here the cache folder's
name carries a hash of every source file that holds kernels and of all that those files import from this
package, so any edit or upgrade that can matter starts a fresh folder. Every kernel also runs as plain Python
under ``NUMBA_DISABLE_JIT=1``.
"""

import ast
import hashlib
import os
from collections.abc import Callable, Iterator
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
    for path in sorted(_sources(package)):
        digest.update(path.relative_to(package).as_posix().encode())
        digest.update(path.read_bytes())
    base = os.environ.get("NUMBA_CACHE_DIR") or user_cache_dir("lifelore")
    return Path(base) / f"kernels-{digest.hexdigest()[:16]}"


def _sources(package: Path) -> set[Path]:
    """The files that hold kernels and every file of the package that they import, directly or not."""
    found: set[Path] = set()
    waiting = [path for path in package.rglob("*.py") if _holds_kernels(path.read_bytes())]
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting += _imported(path, package)
    return found


def _holds_kernels(source: bytes) -> bool:
    return b"@kernel" in source or b"@inlined" in source


def _imported(path: Path, package: Path) -> Iterator[Path]:
    names: list[str] = []
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.ImportFrom) and node.module:
            names += [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        elif isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
    for name in names:
        root, *parts = name.split(".")
        file = package.joinpath(*parts).with_suffix(".py")
        if root == package.name and parts and file.is_file():
            yield file


def kernel(function: F) -> F:
    """Compile `function` on first call (nogil, no fastmath), keep the machine code between processes."""
    return _compiled(function)


def inlined(function: F) -> F:
    """As `kernel`, for the small pieces that kernels call at every step: always inlined into them."""
    return _compiled(function, inline="always")


def _compiled(function: F, **options) -> F:
    previous = numba.config.CACHE_DIR  # type: ignore[attr-defined]
    numba.config.CACHE_DIR = str(kernel_cache_dir())  # type: ignore[attr-defined]
    try:
        return numba.njit(cache=True, nogil=True, no_cfunc_wrapper=True, **options)(function)  # type: ignore[return-value]
    finally:
        numba.config.CACHE_DIR = previous  # type: ignore[attr-defined]
