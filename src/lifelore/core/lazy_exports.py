"""Names that a room exports, each imported from its module when it is first used.

So ``import lifelore.action`` costs nothing, and modules of a room can import one another while it is imported. The
names are those that the room's source imports for type checkers: ``from module import name as name``.
"""

import re
import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any


def lazy_exports(room: str, *own: str) -> tuple[list[str], Callable[[str], Any], Callable[[], list[str]]]:
    """The list ``__all__`` of a package, and its functions ``__getattr__`` and ``__dir__``.

    Parameters
    ----------
    room : str
        The package's ``__name__``.
    *own : str
        Public names that the package itself defines.

    Examples
    --------
    >>> names, find, _ = lazy_exports("lifelore.core")
    >>> find("stream").__name__, "optimal_q" in names
    ('stream', True)
    """
    source = sys.modules[room].__spec__.loader.get_source(room)  # pyright: ignore[reportOptionalMemberAccess, reportAttributeAccessIssue]
    homes = {name: home for home, name in re.findall(r"^ +from (\S+) import \(?\s*(\w+) as \2\b", source, re.M)}
    names = sorted([*own, *homes])

    def find(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {room!r} has no attribute {name!r}")
        return getattr(import_module(homes[name]), name)

    return names, find, lambda: names
