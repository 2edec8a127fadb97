"""Files of a verb's result: a JSON document and its picture in a folder, each written whole or not at all."""

import json
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from lifelore.core.atomic_write import atomic_write
from lifelore.core.errors import StoreError


def write_result(folder: Path, name: str, document: dict[str, Any], draw: Callable[[dict[str, Any]], Any]) -> None:
    """Write ``NAME.json`` and ``NAME.png`` into a folder, which is made if it is not there.

    Parameters
    ----------
    folder : path
    name : str
    document : dict
        Plain data.
    draw : callable
        From the document to a figure.

    Raises
    ------
    StoreError
        The disk refuses.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StoreError(f"cannot write {folder}: {error.strerror}; choose another place") from None
    text = json.dumps(document, indent=2, allow_nan=False) + "\n"
    write_file(folder / f"{name}.json", [text.encode()])
    write_picture(folder / f"{name}.png", document, draw)


def write_picture(path: Path, document: dict[str, Any], draw: Callable[[dict[str, Any]], Any]) -> None:
    """Draw a document and save the figure."""
    from lifelore.figures.style import save_figure

    with warnings.catch_warnings():
        # Names may be of any script; what the font lacks is drawn as a box, and the document has it.
        warnings.filterwarnings("ignore", "Glyph .* missing from")
        save_figure(draw(document), path)


def write_file(path: Path, parts: Iterable[bytes]) -> None:
    """Write the whole file or nothing; StoreError where the disk refuses."""
    try:
        with atomic_write(path) as file:
            file.writelines(parts)
    except OSError as error:
        if isinstance(error, StoreError):
            raise
        raise StoreError(f"cannot write {path}: {error.strerror}; choose another place") from None
