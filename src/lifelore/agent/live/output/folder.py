"""A folder into which files are written, with the errors of what can go wrong there."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from lifelore.core.errors import InputError, StoreError


@contextmanager
def folder_to_write(path: str | Path, argument: str = "out") -> Iterator[Path]:
    """A block that writes into a folder, which is made if it is missing; `argument` is what an error names.

    Raises
    ------
    InputError
        `path` is empty, a file or below a file.
    StoreError
        The block cannot write: the disk is full or read-only, or permission is missing.
    """
    if not str(path).strip() or "\0" in str(path):
        raise InputError(f"{argument} must name a folder, got {str(path)!r}")
    try:
        Path(path).mkdir(parents=True, exist_ok=True)
        yield Path(path)
    except (FileExistsError, NotADirectoryError):
        raise InputError(
            f"{argument} must name a folder, got {path}, which is or lies below a file; name another folder"
        ) from None
    except StoreError:
        raise
    except OSError as error:
        raise StoreError(f"cannot write into {path}: {error.strerror}; choose another folder") from None
