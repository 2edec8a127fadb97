"""`@stored_kernel`: kernels whose machine code later processes load in milliseconds, without importing Numba.

The first process that needs such a kernel compiles it with Numba for its one declared signature and stores the
machine code (`machine_code`). Later processes link that file with llvmlite and call it through ctypes. A command
that runs some tens of kernels for a moment starts half a second sooner.

A stored kernel creates no array; its caller passes all memory. Arguments of other types or layouts run the Numba
version. Under ``NUMBA_DISABLE_JIT=1`` the function stays plain Python.
"""

import ctypes
import os
import re
from collections.abc import Callable
from functools import cached_property
from operator import index
from types import FunctionType
from typing import Any, NamedTuple, TypeVar

import numpy as np

from lifelore.core.compiled.machine_code import linked_address, stored_code

F = TypeVar("F", bound=Callable)
_FINISHED = (0, -2)
"""Statuses of Numba's calling convention: a result, and no result."""
_SCALARS: dict[str, tuple[Callable[[Any], Any], Any]] = {
    "i8": (index, ctypes.c_int64),
    "f8": (float, ctypes.c_double),
}
_SIGNATURE = re.compile(r"(\w+)\((.*)\)")
_ARGUMENT = re.compile(r"(\w+)(?:\[((?:[:,] ?)+)1\])?(?:, |$)")


class ArrayType(NamedTuple):
    """A C-contiguous array argument."""

    dtype: np.dtype
    ndim: int


class Signature(NamedTuple):
    """Types of a kernel: its text in Numba's notation, the type of the result, and the types of the arguments."""

    text: str
    result: str
    arguments: tuple[ArrayType | str, ...]

    @classmethod
    def from_text(cls, text: str) -> "Signature":
        """Parse for example ``f8(f8[:, ::1], i8[::1], i8)``; scalars are i8 and f8, the result may be void."""
        match = _SIGNATURE.fullmatch(text)
        if match is None:
            raise ValueError(f"signature must look like f8(f8[:, ::1], i8), got {text!r}")
        return cls(
            text,
            match[1],
            tuple(
                ArrayType(np.dtype(code), axes.count(",") + 1) if axes else code
                for code, axes in _ARGUMENT.findall(match[2])
            ),
        )

    @property
    def c_types(self) -> list[Any]:
        """The ctypes of the machine code's arguments: result, exception, then all arguments flattened."""
        flat: list[Any] = [ctypes.c_void_p, ctypes.c_void_p]
        for argument in self.arguments:
            if isinstance(argument, ArrayType):
                # Owner and parent, number and size of the items, data, shape and strides.
                flat += [ctypes.c_void_p] * 2 + [ctypes.c_int64] * 2 + [ctypes.c_void_p]
                flat += [ctypes.c_int64] * (2 * argument.ndim)
            else:
                flat.append(_SCALARS[argument][1])
        return flat


class KernelPart:
    """A function that kernels call; from Python it runs as plain Python."""

    def __init__(self, function: Callable, inline: bool = False) -> None:
        self.py_func, self._inline = function, inline
        self.__doc__, self.__name__, self.__module__ = function.__doc__, function.__name__, function.__module__
        self.__wrapped__ = function

    def __call__(self, *arguments: Any) -> Any:
        return self.py_func(*arguments)

    @cached_property
    def dispatcher(self) -> Any:
        """The function compiled by Numba for any types; imports Numba."""
        from lifelore.core.compiled.jit import inlined, kernel

        return (inlined if self._inline else kernel(allocates=False))(self.with_dispatchers)

    @property
    def with_dispatchers(self) -> Callable:
        """The plain function with Numba's dispatchers in the place of the parts that it calls."""
        of = self.py_func
        parts = {
            name: value.dispatcher
            for name in of.__code__.co_names
            if isinstance(value := of.__globals__.get(name), KernelPart)
        }
        copy = FunctionType(of.__code__, of.__globals__ | parts, of.__name__, of.__defaults__)
        copy.__qualname__, copy.__module__, copy.__doc__ = of.__qualname__, of.__module__, of.__doc__
        return copy


class StoredKernel(KernelPart):
    """A kernel with one signature, called as machine code; see the module."""

    def __init__(self, function: Callable, signature: Signature) -> None:
        super().__init__(function)
        self.signature = signature

    @cached_property
    def _machine_code(self) -> Callable | None:
        """The machine code as a ctypes function; None where it cannot be made or linked."""
        code = stored_code(self.py_func, self.signature.text, self._compile)
        address = linked_address(code) if code else None
        if address is None:
            return None
        return ctypes.CFUNCTYPE(ctypes.c_int32, *self.signature.c_types)(address)

    def _compile(self) -> bytes | None:
        from lifelore.core.compiled.numba_internals import compiled_object

        return compiled_object(self.with_dispatchers, self.signature.text, self.signature.c_types)

    def __call__(self, *arguments: Any) -> Any:
        call, flat = self._machine_code, self._flattened(arguments)
        if call is None or flat is None:
            return self.dispatcher(*arguments)
        result = ctypes.c_double() if self.signature.result == "f8" else ctypes.c_int64()
        error = ctypes.c_void_p()
        status = call(ctypes.addressof(result), ctypes.addressof(error), *flat)
        if status not in _FINISHED:
            raise ArithmeticError(f"kernel {self.__name__} failed with status {status}")
        return None if self.signature.result == "void" else result.value

    def _flattened(self, arguments: tuple[Any, ...]) -> list[Any] | None:
        """The arguments of the machine code, None if an array has another type or layout."""
        flat: list[Any] = []
        for value, expected in zip(arguments, self.signature.arguments, strict=True):
            if isinstance(expected, ArrayType):
                if value.dtype != expected.dtype or value.ndim != expected.ndim or not value.flags.carray:
                    return None
                flat += (None, None, value.size, value.itemsize, _address(value), *value.shape, *value.strides)
            else:
                flat.append(_SCALARS[expected][0](value))
        return flat


def _address(array: np.ndarray) -> int:
    """Where a writeable, contiguous array begins; several times as fast as ``array.ctypes.data``."""
    if not array.size:
        return array.ctypes.data
    return ctypes.addressof(ctypes.c_char.from_buffer(array))  # pyright: ignore[reportArgumentType]


def stored_kernel(signature: str) -> Callable[[Callable], Any]:
    """Store a function's machine code for one signature, so that later processes run it without Numba.

    Parameters
    ----------
    signature : str
        In Numba's notation, with C-contiguous arrays and scalars i8 and f8: ``f8(f8[:, ::1], i8)``. The function
        creates no array.

    Returns
    -------
    callable
        Decorator; the decorated function takes positional arguments only.
    """
    return lambda function: function if _plain() else StoredKernel(function, Signature.from_text(signature))


def kernel_part(function: F) -> F:
    """Mark a function that stored kernels call."""
    return function if _plain() else KernelPart(function)  # type: ignore[return-value]


def inlined_part(function: F) -> F:
    """As `kernel_part`, for small functions that kernels call at every step: always inlined."""
    return function if _plain() else KernelPart(function, inline=True)  # type: ignore[return-value]


def _plain() -> bool:
    return os.environ.get("NUMBA_DISABLE_JIT", "0") != "0"
