"""What a result was made from and on: code, commit, libraries, machine, date, and data outside the repository."""

import hashlib
import os
import platform
import subprocess
from collections.abc import Sequence
from contextlib import suppress
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

import lifelore
from lifelore.core.usable_cores import usable_cores

CHECKOUT = Path(__file__).parents[2]
ROOTS = {"lifelore": Path(lifelore.__file__).parent, "reproduction": Path(__file__).parents[1]}
"""Folders of the packages that count as ours."""


DATA = "LIFELORE_DATA"
"""The variable that names the folder of data that are not in the repository."""
SOURCES = ("src", "reproduction", ":!reproduction/results")
"""What git is asked about changed files."""
LIBRARIES = (
    "lifelore", "clingo", "gymnasium", "minigrid", "mujoco", "networkx", "numba", "numpy", "scikit-learn", "scipy",
)  # fmt: skip
"""Libraries whose versions may change a number."""


def provenance(data: Sequence[str] = ()) -> dict[str, Any]:
    """Where a result comes from, plain data.

    Parameters
    ----------
    data : sequence of str
        Folders in that of `DATA` that it reads.

    Returns
    -------
    dict
        ``date`` (UTC); ``commit``, None outside a checkout; ``changed``: whether files of the package differed
        from the commit; ``source``, the key of all our code; ``processor``, ``simd`` (instructions
        that NumPy uses; its logarithms differ with them in the last bit), ``cores``; ``data``: a hash for each of
        the folders, None where it is not there.
    """
    commit, changed = _commit()
    return {
        "date": datetime.now(UTC).strftime("%Y-%m-%d"),
        "commit": commit,
        "changed": changed,
        "source": source_key(),
        "processor": processor(),
        "simd": simd(),
        "cores": usable_cores(),
        "data": {name: data_hash(name) for name in data},
    }


@cache
def versions() -> dict[str, str]:
    """Versions of Python and of those of `LIBRARIES` that are installed."""
    found = {"python": platform.python_version()}
    for name in LIBRARIES:
        with suppress(PackageNotFoundError):
            found[name] = version(name)
    return found


@cache
def _commit() -> tuple[str | None, bool | None]:
    def asked(*arguments: str) -> str:
        done = subprocess.run(
            ["git", "-C", str(CHECKOUT), *arguments], capture_output=True, text=True, check=True, timeout=10
        )
        return done.stdout.strip()

    try:
        if Path(asked("rev-parse", "--show-toplevel")) != CHECKOUT:
            return None, None
        if not asked("ls-files", "reproduction/__init__.py"):  # a copy inside somebody's repository
            return None, None
        return asked("rev-parse", "HEAD"), bool(asked("status", "--porcelain", "--", *SOURCES))
    except (OSError, subprocess.SubprocessError):
        return None, None


@cache
def processor() -> str:
    """The processor's name, as far as the system knows it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    named = next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "")
    return named or platform.processor() or platform.machine()


@cache
def simd() -> str:
    """The vector instructions that NumPy uses here, beyond those that all its processors have."""
    return " ".join(np.show_config(mode="dicts")["SIMD Extensions"]["found"])


def data_hash(name: str) -> str | None:
    """The hash of a folder of outside data; None where it is not there."""
    folder = Path(os.environ.get(DATA, "")) / name
    return _hash_of(folder) if DATA in os.environ and folder.is_dir() else None


@cache
def _hash_of(folder: Path) -> str:
    digest = hashlib.sha256()
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        digest.update(path.relative_to(folder).as_posix().encode() + b"\0")
        with path.open("rb") as file:
            digest.update(hashlib.file_digest(file, "sha256").digest())
    return digest.hexdigest()[:16]


@cache
def source_key() -> str:
    """Hash of the names and contents of every module, and of every file in a folder ``models``."""
    digest = hashlib.sha256()
    for package, root in ROOTS.items():
        for path in sorted([*root.rglob("*.py"), *root.rglob("models/*.*")]):
            digest.update(f"{package}/{path.relative_to(root).as_posix()}".encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
