"""Maps each hashable context of a world to an integer code, the same in every process."""

import hashlib
import math
import numbers
from collections.abc import Hashable
from dataclasses import fields, is_dataclass
from enum import Enum

import numpy as np

from lifelore.core.errors import InputError

CODE_BITS = 47
"""Bits of a code. With a million contexts, two share a code by chance in 0.4 % of lives; `ContextCodes` refuses
it."""
CONTEXT_BITS = 31
"""Bits of the code of a task's context; with a thousand contexts, two share a code in 0.02 % of lives."""
MOST_ACTIONS = 2**16 - 1
"""Maximum number of actions for which code · n_actions + action fits a 64-bit integer."""


def context_code(context: Hashable, bits: int = CODE_BITS) -> int:
    """The code of a context in [0, 2**bits), the same in every process and for equal contexts.

    Parameters
    ----------
    context : hashable
        None, numbers, strings, bytes, enum members, and tuples, frozensets and dataclasses of these.

    Raises
    ------
    InputError
        The context has another type, whose identity may differ between processes, or is NaN.
    """
    digest = hashlib.blake2b(_canonical(context).encode(), digest_size=8).digest()
    return int.from_bytes(digest, "big") >> (64 - bits)


def _canonical(part: Hashable) -> str:
    """A text for each value, the same for values that are equal in Python (1, 1.0 and True)."""
    if isinstance(part, np.generic) and not isinstance(part, str | bytes):
        part = part.item()
    if isinstance(part, numbers.Real) and math.isfinite(part):
        return str(math.floor(part)) if part == math.floor(part) else float(part).hex()
    if part is None or isinstance(part, str):
        return "none" if part is None else ascii(str(part))
    if isinstance(part, bytes):
        return repr(bytes(part))
    if isinstance(part, tuple):
        return f"({','.join(map(_canonical, part))})"
    if isinstance(part, frozenset):
        return f"{{{','.join(sorted(map(_canonical, part)))}}}"
    if isinstance(part, Enum):
        return f"{type(part).__qualname__}.{part.name}"
    if is_dataclass(part) and not isinstance(part, type):
        values = tuple(getattr(part, f.name) for f in fields(part) if f.compare)
        return type(part).__qualname__ + _canonical(values)
    raise InputError(
        "a state or context must be made of finite numbers, text, bytes, enum members, tuples, frozensets or "
        f"dataclasses, got {ascii(part)[:60]} of type {type(part).__name__}; return a tuple of such features"
    )


class ContextCodes:
    """Codes of the contexts met so far; refuses two contexts with the same code.

    contexts : code to context
    """

    def __init__(self, bits: int = CODE_BITS) -> None:
        self.bits = bits
        self._code: dict[Hashable, int] = {}
        self.contexts: dict[int, Hashable] = {}

    def __getitem__(self, context: Hashable) -> int:
        """The code of a context; InputError if another context has the same code."""
        try:
            return self._code[context]
        except KeyError:
            return self._meet(context)
        except TypeError:
            raise InputError(
                f"a state or context must be hashable, got {type(context).__name__}; return a tuple or a number"
            ) from None

    def _meet(self, context: Hashable) -> int:
        code = context_code(context, self.bits)
        other = self.contexts.setdefault(code, context)
        if other != context:
            raise InputError(
                f"contexts {ascii(other)[:60]} and {ascii(context)[:60]} share the code {code}, so their counts "
                "would mix; change the features slightly, for instance add a constant to the tuple"
            )
        self._code[context] = code
        return code
