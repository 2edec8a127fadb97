"""Names that a room exports, each imported from its module when it is first used.

So ``import lifelore.action`` costs nothing, and modules of a room can import one another while it is imported. The
names are those that the room imports for type checkers: ``from module import name as name``. They are read from
the room's compiled code, which is there without its source, too.
"""

import dis
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
    module, homes, home = sys.modules[room], dict[str, str](), ""
    code = module.__spec__.loader.get_code(room)  # pyright: ignore[reportOptionalMemberAccess, reportAttributeAccessIssue]
    for step in dis.get_instructions(code):
        if step.opname == "IMPORT_NAME":
            home = step.argval
        elif step.opname == "IMPORT_FROM" and step.argval not in vars(module):
            homes[step.argval] = home
    names = sorted([*own, *homes])

    def find(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {room!r} has no attribute {name!r}")
        return getattr(import_module(homes[name]), name)

    return names, find, lambda: names
