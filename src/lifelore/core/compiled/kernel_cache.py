"""Cache folder of compiled kernels, named by a hash of their sources; removes stale folders.

Numba's own cache looks at the file of the decorated function alone: when a *called* function in another
file changes, or a constant that it reads, the old machine code answers silently. Here the folder's name
carries a hash of every source file that holds kernels and of all that those files import from this package,
so any edit or upgrade that can matter starts a fresh folder. Neither the place nor the age of a source file
matters, so a folder can be copied with an image.
"""

import hashlib
import os
import re
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[2]
STALE_DAYS = 30
"""Days without use after which the folder of another version is removed; fewer free the disk sooner."""
_DAY = 24 * 3600.0
_IMPORTS = re.compile(
    rb"^[ \t]*(?:from[ \t]+([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n]+)|import[ \t]+([\w., \t]+))", re.MULTILINE
)
_MARKS = (b"@kernel", b"@inlined", b"@stored_kernel")
_NAME = re.compile(rb"[\w.]+")
_COMMENT = re.compile(rb"#[^\n]*")


@cache
def kernel_cache_dir() -> Path:
    """Folder of the compiled kernels: ``NUMBA_CACHE_DIR`` or the user's cache, then a hash of the sources.

    Once a day a use is noted in the folder's time, and folders of other versions that nobody used for
    `STALE_DAYS` are removed.
    """
    base = cache_base()
    folder = base / f"kernels-{source_hash()}"
    # A folder that cannot be written, in an image say, is still read.
    with suppress(OSError):
        if not folder.is_dir() or time.time() - folder.stat().st_mtime > _DAY:
            folder.mkdir(parents=True, exist_ok=True)
            os.utime(folder)
            remove_stale(base, keep=folder)
    return folder


def cache_base() -> Path:
    """Folder of all caches: ``NUMBA_CACHE_DIR`` or the user's cache folder."""
    named = os.environ.get("NUMBA_CACHE_DIR")
    if named:
        return Path(named)
    from platformdirs import user_cache_dir

    return Path(user_cache_dir("lifelore"))


def source_hash(package: Path = PACKAGE) -> str:
    """16 hexadecimal digits that change with Numba's version and with every source that kernels read."""
    import numba

    digest = hashlib.sha256(numba.__version__.encode())
    sources = kernel_sources(package)
    for path in sorted(sources):
        digest.update(path.relative_to(package).as_posix().encode())
        digest.update(sources[path])
    return digest.hexdigest()[:16]


def kernel_sources(package: Path) -> dict[Path, bytes]:
    """Content of the files that hold kernels and of all that they import from the package, directly or not."""
    content = {Path(path): Path(path).read_bytes() for path in _python_files(str(package))}
    kernels = [path for path, source in content.items() if any(mark in source for mark in _MARKS)]
    return imported_sources(kernels, package, content.get)


def imported_sources(files: list[Path], package: Path, read: Callable[[Path], bytes | None]) -> dict[Path, bytes]:
    """Content of some files and of all that they import from the package, directly or not.

    Parameters
    ----------
    files : list of Path
    package : Path
    read : callable
        Content of a file, None where there is no such file.
    """
    found: dict[Path, bytes] = {}
    waiting = list(files)
    while waiting:
        path = waiting.pop()
        if path not in found and (source := read(path)) is not None:
            found[path] = source
            waiting += _imported(source, package)
    return found


def _python_files(folder: str) -> Iterator[str]:
    for entry in os.scandir(folder):
        if entry.is_dir():
            yield from _python_files(entry.path)
        elif entry.name.endswith(".py"):
            yield entry.path


def _imported(source: bytes, package: Path) -> Iterator[Path]:
    """Files that the import statements of `source` may name; parsing them properly would take ten times longer."""
    root = package.name
    source = _COMMENT.sub(b"", source).replace(b"\\\n", b"")
    for module, names, modules in _IMPORTS.findall(source):
        first = module.decode()
        members = [f"{first}.{name.decode()}" for name in _NAME.findall(names)] if module else []
        for name in (first, *members, *(name.decode() for name in _NAME.findall(modules))):
            if name.startswith(f"{root}."):
                yield package.joinpath(*name.split(".")[1:]).with_suffix(".py")


def remove_stale(base: Path, keep: Path) -> None:
    """Remove the kernel folders in `base` that were not used for `STALE_DAYS`, except `keep`."""
    oldest = time.time() - STALE_DAYS * _DAY
    for folder in base.glob("kernels-" + "[0-9a-f]" * 16):
        # Another process may remove it at the same moment.
        with suppress(OSError):
            if folder != keep and folder.stat().st_mtime < oldest:
                shutil.rmtree(folder, ignore_errors=True)
