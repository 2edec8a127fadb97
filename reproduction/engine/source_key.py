"""A key of the code that a result rests on: a hash of a module and of everything of ours it imports.

Trained models that ship in a room's folder ``models`` count with that room's modules.

Figures draw results and cannot change them, so they take no part.
"""

import ast
import hashlib
import sys
from functools import cache
from pathlib import Path

import lifelore

CHECKOUT = Path(__file__).parents[2]
ROOTS = {"lifelore": Path(lifelore.__file__).parent, "reproduction": Path(__file__).parents[1]}
"""Folders of the packages that count as ours."""
_NO_PART = ("lifelore.figures", "reproduction.figures")


@cache
def source_key(module: str) -> str:
    """Hash of the sources of `module` and of all it imports from our packages, at whatever depth."""
    digest = hashlib.sha256()
    sources = {name: path for name in _closure(module) if (path := _path(name))}
    for name, path in sorted(sources.items()):
        digest.update(name.encode())
        digest.update(path.read_bytes())
    for model in sorted({model for path in sources.values() for model in path.parent.glob("models/*")}):
        digest.update(model.name.encode())
        digest.update(model.read_bytes())
    return digest.hexdigest()[:16]


def foreign_modules(module: str) -> set[str]:
    """Top names of the modules outside our packages that `module` and all it rests on import, but for Python's."""
    tops = {name.partition(".")[0] for own in _closure(module) for name in _imports(own)}
    return tops - ROOTS.keys() - sys.stdlib_module_names


def _closure(module: str) -> set[str]:
    found, left = set(), [module]
    while left:
        name = left.pop()
        if name not in found and _path(name) and not name.startswith(_NO_PART):
            found.add(name)
            left += _imports(name)
    return found


def _path(module: str) -> Path | None:
    """The file of one of our modules; None if the name is not such a module."""
    top, *rest = module.split(".")
    if top not in ROOTS:
        return None
    base = ROOTS[top].joinpath(*rest)
    return next((p for p in (base.with_suffix(".py"), base / "__init__.py") if p.is_file()), None)


def _imports(module: str) -> list[str]:
    return _imported_by(_path(module).read_text(encoding="utf-8"))  # type: ignore[union-attr]


@cache
def _imported_by(source: str) -> list[str]:
    names = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            # What is imported from a package may be a module of its own.
            names += [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
    return names
