"""What `lifelore perceive` says of a scene, as figures need it: numbers for names, arrays for lists."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE

TABLE_NAME = "table"


@dataclass(frozen=True, eq=False)
class Network:
    """One object's contact points ``(k, 3)`` and the edges ``(m, 2)`` between them."""

    at: NDArray[np.float64]
    edges: NDArray[np.int64]


@dataclass(frozen=True)
class Bond:
    """A relation to draw: ``relation(a, b)``."""

    a: int
    b: int
    relation: str
    confidence: float
    gap: float | None

    @property
    def with_table(self) -> bool:
        """Whether the table is one of the two."""
        return TABLE in (self.a, self.b)


@dataclass(frozen=True, eq=False)
class SceneDocument:
    """The document in figures' terms.

    Parameters
    ----------
    networks : dict
        `Network` by object; not the table's, whose contact points lie under everything.
    bonds : tuple of Bond
        Surest first among each relation; without *none*.
    contact_edges : (m, 2, 3) float64
        Ends of the edges between objects.
    holes : tuple of (k, 3) float64
        Corners of each, in order.
    """

    networks: dict[int, Network]
    bonds: tuple[Bond, ...]
    contact_edges: NDArray[np.float64]
    holes: tuple[NDArray[np.float64], ...]


def read_document(document: Mapping) -> SceneDocument:
    """From the JSON of `lifelore perceive`; absent parts count as empty.

    Raises
    ------
    InputError
        An edge or a hole names a contact point that no object has.
    """
    networks = {}
    for entry in document.get("objects", ()):
        at = np.array([contact["xyz"] for contact in entry.get("contact_points", ())], float).reshape(-1, 3)
        edges = np.array(entry.get("edges", ()), np.int64).reshape(-1, 2)
        if len(edges) and not (edges.min() >= 0 and edges.max() < len(at)):
            raise InputError(
                f"edges of object {entry['id']} must join its {len(at)} contact points, got {edges.max()}"
            )
        networks[number_of(entry["id"])] = Network(at, edges)
    ends = [
        [_corner(networks, end) for end in edge]
        for edge in document.get("contact_edges", ())
        if TABLE not in (number_of(edge[0][0]), number_of(edge[1][0]))
    ]
    holes = tuple(_hole(networks, hole) for hole in document.get("holes", ()))
    networks.pop(TABLE, None)
    return SceneDocument(networks, _bonds(document), np.array(ends, float).reshape(-1, 2, 3), holes)


def number_of(name: int | str) -> int:
    """The label of an object named in a document: the table's for its name, else the number itself."""
    return TABLE if name == TABLE_NAME else int(name)


def _bonds(document: Mapping) -> tuple[Bond, ...]:
    bonds = [
        Bond(number_of(r["a"]), number_of(r["b"]), r["relation"], float(r.get("confidence", 1.0)), r.get("gap"))
        for r in document.get("relations", ())
        if r["relation"] != "none"
    ]
    order = {"on": 0, "both": 1, "adjacent": 2}
    return tuple(sorted(bonds, key=lambda bond: (order.get(bond.relation, 3), bond.relation, bond.a, bond.b)))


def _corner(networks: dict[int, Network], end: Sequence) -> NDArray[np.float64]:
    number, node = number_of(end[0]), int(end[1])
    if number not in networks or not 0 <= node < len(networks[number].at):
        raise InputError(f"contact point {node} of object {end[0]} is not in the document's objects")
    return networks[number].at[node]


def _hole(networks: dict[int, Network], hole: Mapping | Sequence) -> NDArray[np.float64]:
    """Corners of a hole: places (``outline`` or ``xyz``), or contact points, pairs of object and number."""
    if isinstance(hole, Mapping):
        for key in ("outline", "xyz"):
            if key in hole:
                return np.array(hole[key], float).reshape(-1, 3)
        hole = hole.get("nodes", hole.get("cycle", ()))
    corners = [end if len(end) == 3 else _corner(networks, end) for end in hole]
    return np.array(corners, float).reshape(-1, 3)
