"""A scene with its points as bytes: a fifth of the size of JSON, and a program reads them without parsing.

Little-endian, without gaps: ``uint32 n``; ``float32 (n, 3)``, the points in metres in the scene frame;
``int32 (n,)``, their labels (0 none, 1 the table, else the number of an object); ``uint8 (n, 3)``, their colours
(grey without a camera's colours); then the document of `perceive` as JSON in UTF-8, with two further keys:
``points`` (``shown``, the n above; ``of``, the number in the scene) and ``table_contact_points`` (the positions to
which ``["table", i]`` of ``contact_edges`` refers).
"""

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from lifelore.core.labelled_cloud import TABLE

if TYPE_CHECKING:
    from lifelore.perception.scene import Scene

MOST_POINTS = 80_000
"""Largest number of points; a browser draws more too slowly to turn them by hand. The rest is left out evenly."""
GREY = 128


def scene_bytes(scene: "Scene", document: Mapping[str, Any], most: int = MOST_POINTS) -> bytes:
    """The points of a scene and its document as bytes, in the layout above.

    Parameters
    ----------
    scene : Scene
    document : mapping
        JSON data about the scene.
    most : int
        Largest number of points, at least 1.
    """
    cloud = scene.cloud
    every = len(cloud.points)
    chosen = np.linspace(0, every - 1, min(every, most)).round().astype(np.int64)
    colours = np.full((every, 3), GREY, np.uint8) if cloud.colours is None else cloud.colours
    table = scene.networks.get(TABLE)
    nodes = [] if table is None else table.nodes
    described = {
        **document,
        "points": {"shown": len(chosen), "of": every},
        "table_contact_points": [[round(float(x), 6) for x in node.position] for node in nodes],
    }
    return b"".join(
        (
            np.uint32(len(chosen)).astype("<u4").tobytes(),
            cloud.points[chosen].astype("<f4").tobytes(),
            cloud.labels[chosen].astype("<i4").tobytes(),
            np.ascontiguousarray(colours[chosen], np.uint8).tobytes(),
            json.dumps(described, allow_nan=False).encode(),
        )
    )
