"""Files of machine code for `stored_kernel`: named by a hash of the sources, linked by llvmlite without Numba."""

import hashlib
import os
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from importlib.util import find_spec
from itertools import count
from pathlib import Path
from typing import Any

from lifelore.core.compiled.kernel_cache import PACKAGE, STALE_DAYS, cache_base, imported_sources

SYMBOL = "kernel"
"""Name of the function in each file."""
SUFFIX = ".o"
_FORMAT = b"1"
"""Changes with the way in which machine code is called."""
_CHECK = 32
"""Bytes of the checksum at the head of each file; a damaged file is compiled again."""
_used: set[Path] = set()
_DAY = 24 * 3600.0
_numbers = count()
"""Numbers of the libraries, which must have different names even where linking fails."""
_linked: list[Any] = []
"""Linked libraries; they must live as long as their functions."""


def machine_code_folder() -> Path:
    """Folder of the files: beside the folders of Numba's cache."""
    return cache_base() / "machine-code"


def stored_code(function: Callable, signature: str, make: Callable[[], bytes | None]) -> bytes | None:
    """The stored machine code of a function; where there is none, what `make` compiles, stored if possible."""
    path = _file(function, signature)
    with suppress(OSError):
        check, code = (content := path.read_bytes())[:_CHECK], content[_CHECK:]
        if check == hashlib.sha256(code).digest():
            _used.add(path)
            _note_use(path)
            return code
    code = make()
    if code:
        with suppress(OSError):
            _store(path, hashlib.sha256(code).digest() + code)
            _used.add(path)
    return code


def used_files() -> set[Path]:
    """The files that this process has read or stored."""
    return set(_used)


def linked_address(code: bytes) -> int | None:
    """Address of the function in an object file, or None if the object cannot be linked."""
    from llvmlite import binding

    try:
        library = binding.JITLibraryBuilder().add_object_img(code).export_symbol(SYMBOL).add_current_process()
        _linked.append(library.link(_linker(), f"library {next(_numbers)}"))
    except RuntimeError:
        return None
    return _linked[-1][SYMBOL]


@cache
def _linker() -> Any:
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    return binding.create_lljit_compiler(suppress_errors=True)


def _file(function: Callable, signature: str) -> Path:
    source = Path(function.__code__.co_filename)
    name = f"{source.stem}.{function.__name__}"
    digest = hashlib.sha256(_environment() + f"{name} {signature}".encode() + _sources_hash(source))
    return machine_code_folder() / f"{name}-{digest.hexdigest()[:16]}{SUFFIX}"


@cache
def _environment() -> bytes:
    """All that machine code depends on besides the sources: processor, Numba, and llvmlite."""
    import llvmlite
    from llvmlite import binding

    name, features = os.environ.get("NUMBA_CPU_NAME"), os.environ.get("NUMBA_CPU_FEATURES")
    found = find_spec("numba")
    parts = [
        _FORMAT,
        Path(found.origin).with_name("_version.py").read_bytes() if found and found.origin else b"",
        llvmlite.__version__.encode(),
        binding.get_process_triple().encode(),
        (binding.get_host_cpu_name() if name is None else name).encode(),
        (binding.get_host_cpu_features().flatten() if features is None else features).encode(),
    ]
    return hashlib.sha256(b"\0".join(parts)).digest()


@cache
def _sources_hash(source: Path) -> bytes:
    """Hash of a file and of all that it imports from this package, directly or not."""
    digest = hashlib.sha256()
    for path, content in sorted(imported_sources([source], PACKAGE, _content).items()):
        digest.update(path.as_posix().removeprefix(PACKAGE.as_posix()).encode() + b"\0" + content)
    return digest.digest()


def _content(path: Path) -> bytes | None:
    try:
        return path.read_bytes()
    except OSError:
        return None


def _store(path: Path, code: bytes) -> None:
    """Write a file at once, and remove the files of other versions of this kernel that nobody used for long."""
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_suffix(f".{os.getpid()}")
    draft.write_bytes(code)
    draft.replace(path)
    oldest = time.time() - STALE_DAYS * _DAY
    for other in path.parent.glob(f"{path.name.rpartition('-')[0]}-*{SUFFIX}"):
        with suppress(OSError):
            if other.stat().st_mtime < oldest:
                other.unlink()


def _note_use(path: Path) -> None:
    # A folder that cannot be written, in an image say, is still read.
    with suppress(OSError):
        if time.time() - path.stat().st_mtime > _DAY:
            os.utime(path)
