"""A key of the code that results rest on: a hash of all our sources and of the trained models among them."""

import hashlib
from functools import cache
from pathlib import Path

import lifelore

CHECKOUT = Path(__file__).parents[2]
ROOTS = {"lifelore": Path(lifelore.__file__).parent, "reproduction": Path(__file__).parents[1]}
"""Folders of the packages that count as ours."""


@cache
def source_key() -> str:
    """Hash of the names and contents of every module, and of every file in a folder ``models``."""
    digest = hashlib.sha256()
    for package, root in ROOTS.items():
        for path in sorted([*root.rglob("*.py"), *root.rglob("models/*.*")]):
            digest.update(f"{package}/{path.relative_to(root).as_posix()}".encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
