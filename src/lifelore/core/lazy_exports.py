"""Names that a room exports, each imported from its module when it is first used.

So ``import lifelore.action`` costs nothing, and modules of a room can import one another while it is imported.
"""

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def lazy_exports(room: str, homes: Mapping[str, str]) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """The functions ``__getattr__`` and ``__dir__`` of a package whose ``__all__`` lists its names.

    Parameters
    ----------
    room : str
        The package's ``__name__``.
    homes : mapping of str to str
        Exported name → its module, relative to the package with a leading dot, or absolute.

    Examples
    --------
    >>> find, names = lazy_exports("lifelore.core", {"stream": ".streams"})
    >>> find("stream").__name__, "optimal_q" in names()
    ('stream', True)
    """

    def find(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {room!r} has no attribute {name!r}")
        return getattr(import_module(homes[name], room), name)

    return find, lambda: sorted(sys.modules[room].__all__)
