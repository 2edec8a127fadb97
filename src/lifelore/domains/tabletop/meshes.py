"""A user's mesh as a shape: convex pieces, metres, read by trimesh."""

from functools import lru_cache
from pathlib import Path

import numpy as np

from lifelore.core.errors import InputError
from lifelore.domains.tabletop.shapes import Shape, hull

LARGEST, SMALLEST = 0.6, 0.01
"""Metres: what fits on the table, and what its camera still resolves."""
_PIECES = 64


@lru_cache(maxsize=64)
def shape_from_mesh(path: str) -> Shape:
    """A mesh's connected pieces, each as its convex hull, about the middle of the whole.

    A piece that is not convex is filled up to its hull: cut it into convex pieces beforehand where that matters.

    Raises
    ------
    InputError
        The file is missing, holds no mesh or too many pieces, or its size in metres makes no sense on a table.
    """
    import trimesh

    if not Path(path).is_file():
        raise InputError(f"mesh '{path}' is not a file: name one that trimesh reads (STL, OBJ, PLY, GLB, …)")
    try:
        mesh = trimesh.load_mesh(path)
        pieces = [piece.convex_hull.vertices for piece in mesh.split(only_watertight=False)]
    except Exception as error:
        raise InputError(f"mesh '{path}' cannot be read: {error}") from None
    if not 1 <= len(pieces) <= _PIECES:
        raise InputError(f"mesh '{path}' must have 1 to {_PIECES} pieces, it has {len(pieces)}")
    size = float(np.ptp(np.concatenate(pieces), axis=0).max())
    if not SMALLEST <= size <= LARGEST:
        raise InputError(
            f"mesh '{path}' must be {SMALLEST} to {LARGEST} m large, it is {size:.4g}: scale it, "
            "it is perhaps in millimetres"
        )
    return Shape("mesh", tuple(hull(np.asarray(piece)) for piece in pieces)).centred()
