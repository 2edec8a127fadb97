"""Access to Numba's undocumented internals: a kernel cache that loads quickly, or None where they have changed."""

import ctypes
import hashlib
import os
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import numba

from lifelore.core.compiled.kernel_cache import PACKAGE, kernel_cache_dir
from lifelore.core.compiled.machine_code import SYMBOL

NO_COUNTING = {"_nrt": False}
"""Options of `numba.njit` for a kernel that counts no references; for use where `quick_cache` is not None."""
_njit: Any = numba.njit
_LLVM_TYPES = {ctypes.c_void_p: "ptr", ctypes.c_int64: "i64", ctypes.c_double: "double"}


@cache
def quick_cache() -> Callable[[Callable], Any] | None:
    """A function that gives a kernel its cache on disk; None where this release of Numba has other internals.

    Loading a kernel from Numba's own cache fills all registries (0.6 s), which only compiling needs; this one does
    not. Without it, and without `NO_COUNTING`, everything works, but slower. A test fails as soon as a release of
    Numba makes this None.
    """
    try:
        found = _quick_cache_class()
        found(_nothing)
        _njit(no_cfunc_wrapper=True, **NO_COUNTING)(_nothing)
    except (ImportError, AttributeError, TypeError, KeyError, RuntimeError):
        return None
    return found


def compiled_object(function: Callable, signature: str, c_types: Sequence[Any]) -> bytes | None:
    """Object file with the machine code of a function that creates no array, as its only symbol `SYMBOL`.

    None where this release of Numba calls functions otherwise than with arguments of `c_types`.
    """
    from llvmlite import binding

    if quick_cache() is None:
        return None
    compiled: Any = _njit(nogil=True, no_cfunc_wrapper=True, no_cpython_wrapper=True, **NO_COUNTING)(function)
    compiled.compile(signature)
    (result,) = compiled.overloads.values()
    _, cpu, features = result.library.codegen.magic_tuple()
    target = binding.Target.from_triple(binding.get_process_triple())
    machine = target.create_target_machine(cpu=cpu, features=features, opt=3, reloc="pic", codemodel="default")
    module = binding.parse_assembly(result.library.get_llvm_str())
    entry = module.get_function(result.fndesc.llvm_func_name)
    if [str(argument.type) for argument in entry.arguments] != [_LLVM_TYPES[c_type] for c_type in c_types]:
        return None
    for value in (*module.functions, *module.global_variables):
        if not value.is_declaration and value.name != entry.name:
            value.linkage = "internal"
    entry.name = SYMBOL
    passes = binding.create_new_module_pass_manager()
    passes.add_global_dead_code_eliminate_pass()
    passes.run(module, binding.create_pass_builder(machine, binding.create_pipeline_tuning_options(0)))
    return machine.emit_object(module)


def _nothing() -> None:
    """A kernel to try Numba with."""


@cache
def _hash_of(file: str) -> str:
    return hashlib.sha256(Path(file).read_bytes()).hexdigest()


def _quick_cache_class() -> Any:
    from numba.core import caching, runtime

    locator: Any = caching._CacheLocator
    implementation: Any = caching.CompileResultCacheImpl
    parent: Any = caching.FunctionCache

    class Locator(locator):
        """Finds a kernel's machine code by the kernel's place in the package."""

        def __init__(self, function: Callable) -> None:
            self._file, self._line = function.__code__.co_filename, function.__code__.co_firstlineno
            self._path = str(kernel_cache_dir() / Path(self._file).relative_to(PACKAGE).parent)

        def get_cache_path(self) -> str:
            return self._path

        def ensure_cache_path(self) -> None:
            os.makedirs(self._path, exist_ok=True)

        def get_source_stamp(self) -> str:
            # The folder's name says which sources, but a process may live through an upgrade.
            return _hash_of(self._file)

        def get_disambiguator(self) -> str:
            return str(self._line)

        @classmethod
        def from_function(cls, function: Callable, _file: str) -> "Locator":
            return cls(function)

    class Implementation(implementation):
        def __init__(self, function: Callable) -> None:
            self._lineno = function.__code__.co_firstlineno
            self._locator = Locator(function)
            name = f"{Path(function.__code__.co_filename).stem}.{function.__qualname__}"
            self._filename_base = self.get_filename_base(name, getattr(sys, "abiflags", ""))

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
