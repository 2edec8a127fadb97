"""Bytes of a user's file, read with limits, and errors of decoders as one line."""

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import numpy as np

from lifelore.core.errors import InputError

MAX_FILE_BYTES = 4 * 2**30
T = TypeVar("T")


def file_content(path: Path, kinds: str, limit: int = MAX_FILE_BYTES) -> bytes:
    """The bytes of a file.

    Parameters
    ----------
    path : Path
    kinds : str
        The kinds of files that may be given, for the message.
    limit : int
        Largest number of bytes.

    Raises
    ------
    InputError
        There is no such file, or it is larger than `limit`, or cannot be read.
    """
    try:
        # Reading a pipe or a device could block for ever.
        if path.exists() and not path.is_file():
            raise InputError(f"is no file; give {kinds}")
        if path.stat().st_size > limit:
            size = f"{limit // 2**30} GiB" if limit >= 2**30 else f"{limit // 2**20} MiB"
            raise InputError(f"is larger than {size}; give {kinds} of at most this size")
        return path.read_bytes()
    except FileNotFoundError:
        raise InputError("no such file") from None
    except (OSError, ValueError) as error:
        raise InputError(f"cannot be read ({error})") from None


def one_line_errors(name: str, kind: str, read: Callable[[], T]) -> T:
    """What `read` gives; any failure becomes an InputError of one line that begins with `name`.

    Parameters
    ----------
    name : str
        Of the file.
    kind : str
        What the file should hold, such as ``"a cloud"``.
    read : callable
    """
    try:
        # A damaged number may overflow in between; later checks judge the result.
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return read()
    except InputError as error:
        raise InputError(f"{name}: {_one_line(str(error))}") from None
    except MemoryError:
        raise InputError(f"{name}: does not fit into memory; crop or thin it") from None
    except Exception as error:  # a damaged file can fail anywhere in its decoder
        raise InputError(f"{name}: is damaged or not {kind} ({_one_line(str(error))}); write it again") from error


def _one_line(text: str) -> str:
    # A damaged file may hold any characters, including control characters of a terminal.
    return "".join(letter if letter.isprintable() else "?" for letter in " ".join(text.split()))[:300]
