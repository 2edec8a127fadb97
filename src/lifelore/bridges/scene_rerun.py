"""Logs a perceived scene as an ``.rrd`` file for the viewer of Rerun; needs the extra ``view``.

Points, boxes, contact points with normals and contact edges stand in the scene's frame below ``scene``; ``camera``
is the pose of the camera's frame, and below ``relations`` each relation is a graph.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lifelore.bridges.detection3d import quaternion
from lifelore.core.errors import MissingExtraError

if TYPE_CHECKING:
    from lifelore.perception.scene import Scene

_RADIUS, _NORMAL = 0.003, 0.03
"""Metres: radius of a contact point's mark, length of its normal."""


def write_scene_rrd(path: str | Path, scene: "Scene", document: Mapping[str, Any]) -> None:
    """Write a scene and its document; a file of this name is replaced.

    Raises
    ------
    MissingExtraError
        rerun is not installed.
    OSError
        The file cannot be written.
    """
    with recording(path) as (rr, log):
        log.log("scene", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        pose = scene.cloud.origin.T_scene_camera
        log.log("camera", rr.Transform3D(translation=pose[:3, 3], mat3x3=pose[:3, :3]), static=True)
        log.log("scene/points", rr.Points3D(scene.cloud.points, colors=scene.cloud.colours), static=True)
        log.log("scene/boxes", _boxes(rr, document), static=True)
        nodes = [node for network in scene.networks.values() for node in network.nodes]
        places = np.array([node.position for node in nodes]).reshape(-1, 3)
        normals = np.array([node.normal for node in nodes]).reshape(-1, 3) * _NORMAL
        log.log("scene/contacts", rr.Points3D(places, radii=_RADIUS), static=True)
        log.log("scene/normals", rr.Arrows3D(origins=places, vectors=normals), static=True)
        edges = [[scene.position(e.a, e.node_a), scene.position(e.b, e.node_b)] for e in scene.contact_edges]
        log.log("scene/contact_edges", rr.LineStrips3D(np.array(edges).reshape(-1, 2, 3)), static=True)
        _log_relations(rr, log, document)


@contextmanager
def recording(path: str | Path) -> Iterator[tuple[Any, Any]]:
    """The library, and a log that it writes to a file; errors as in `write_scene_rrd`."""
    rr = rerun()
    Path(path).touch()  # the library only warns of a file that it cannot write
    with rr.RecordingStream("lifelore") as log:
        log.save(path)
        yield rr, log


def rerun() -> Any:
    """The library.

    Raises
    ------
    MissingExtraError
        It is not installed.
    """
    try:
        import rerun as library  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise MissingExtraError("a log in .rrd needs the extra view: pip install 'lifelore[view]'") from None
    return library


def _boxes(rr: Any, document: Mapping[str, Any]) -> Any:
    boxes = [one["box"] for one in document["objects"]]
    turns = [list(quaternion(box["axes"]).values()) for box in boxes]
    return rr.Boxes3D(
        centers=np.array([box["centre"] for box in boxes]).reshape(-1, 3),
        half_sizes=np.array([box["size"] for box in boxes]).reshape(-1, 3) / 2,
        quaternions=np.array(turns).reshape(-1, 4),
        labels=[str(one["id"]) for one in document["objects"]],
    )


def _log_relations(rr: Any, log: Any, document: Mapping[str, Any]) -> None:
    """One graph a relation's name, since a graph of Rerun has no names at its edges."""
    found = [one for one in document["relations"] if one["relation"] != "none"]
    names = [str(one["id"]) for one in document["objects"]] + ["table"]
    for relation in sorted({one["relation"] for one in found}):
        edges = [(str(one["a"]), str(one["b"])) for one in found if one["relation"] == relation]
        graph = rr.GraphNodes(names, labels=names), rr.GraphEdges(edges, graph_type="directed")
        log.log(f"relations/{relation}", *graph, static=True)
