"""Files of a verb's result: a JSON document and its picture in a folder, each written whole or not at all."""

import json
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from lifelore.core.atomic_write import refused_writes, write_file


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
    path = folder / f"{name}.json"
    with refused_writes(path):
        folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps(document, indent=2, allow_nan=False) + "\n"
    write_file(path, text.encode(), "the result")
    write_picture(folder / f"{name}.png", document, draw)


def write_picture(path: Path, document: dict[str, Any], draw: Callable[[dict[str, Any]], Any]) -> None:
    """Draw a document and save the figure."""
    from lifelore.figures.style import save_figure

    with warnings.catch_warnings():
        # Names may be of any script; what the font lacks is drawn as a box, and the document has it.
        warnings.filterwarnings("ignore", "Glyph .* missing from")
        save_figure(draw(document), path)
