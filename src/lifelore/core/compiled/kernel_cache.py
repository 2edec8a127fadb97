"""Cache folders of compiled kernels, named by a hash of the sources that the kernels are compiled from.

Numba's own cache compares only the file of the decorated function: after an edit of a *called* function in another
file, or of a constant there, it loads the old machine code. So each file with kernels has its own folder, whose
name carries a hash of that file and of all files of this package that it imports, directly or not.
"""

import hashlib
import os
import re
import shutil
import time
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[2]
STALE_DAYS = 30
"""Days after which the folder of another version of a file is removed; fewer free the disk sooner."""
_IMPORT = re.compile(rb"^[ \t]*from lifelore\.([\w.]+) import (\([^)]*\)|.+)", re.MULTILINE)


def cache_folder() -> Path:
    """Folder of all compiled kernels: in ``NUMBA_CACHE_DIR`` or the user's cache folder."""
    from platformdirs import user_cache_dir

    return Path(os.environ.get("NUMBA_CACHE_DIR") or user_cache_dir("lifelore")) / "kernels"


@cache
def kernel_folder(source: Path) -> Path | None:
    """Folder for the kernels of one file; None where there is no such file, or nothing can be stored."""
    digest = hashlib.sha256()
    try:
        for path in sorted(kernel_sources(source)):
            digest.update(_source(path)[0])
        name = ".".join(source.with_suffix("").parts[-3:])
        folder = cache_folder() / f"{name}-{digest.hexdigest()[:16]}"
        if not folder.is_dir():
            folder.mkdir(parents=True, exist_ok=True)
            for other in folder.parent.glob(f"{name}-*"):
                if time.time() - other.stat().st_mtime > STALE_DAYS * 24 * 3600:
                    shutil.rmtree(other, ignore_errors=True)
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None


def kernel_sources(source: Path) -> set[Path]:
    """A file and all files of this package that it imports, directly or not."""
    found: set[Path] = set()
    waiting = [source]
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting += _source(path)[1]
    return found


@cache
def _source(path: Path) -> tuple[bytes, list[Path]]:
    """Content of a file, and the files of this package that its import statements name."""
    content, files = path.read_bytes(), []
    for module, names in _IMPORT.findall(content):
        place = PACKAGE.joinpath(*module.decode().split("."))
        members = [place / f"{name}.py" for name in re.findall(r"\w+", names.decode())]
        files += [place.with_suffix(".py"), place / "__init__.py", *members]
    return content, [file for file in files if file.is_file()]
