"""Holes: ways through a scene that are closed by objects which meet in more than one place.

The loops of thesis Fig. 2.6: cycles of the graph whose nodes are all contact points, and whose edges are those of
the contact point networks and the contact edges between them. A cycle alone is not a hole: one long contact that
came out as two contact points makes one too. So a loop counts only if it *opens*, by a rule in metres that does
not depend on how densely the points lie:

    For each object of the loop, go from the node where the loop enters it to the node where it leaves. Every half
    `clearance` of the way, take a slice across it, `clearance` thick, and in it the smallest visible distance from
    the object to the loop's other objects. The loop opens along the object where that distance exceeds, by
    `clearance` or more and in two slices in a row, the larger of the distances in the slices at both ends, where
    the contacts are.

The ends are what is measured against since a true contact can look centimetres wide, its faces being hidden. A
slice in which either side has no point shows nothing and opens nothing; nor does one where the middle of the
smallest distance is not *seen* to be free, where the camera's place is known: something must be visible behind it
and nothing before it. What hides a contact's middle would otherwise make a hole of it. The loop is a hole if it
opens along every object through which it has a way longer than `clearance`, and there is at least one.

Only contacts that close the way join a loop: of pairs that bear (*on*, *both*); of neighbours whose visible gap is
at most `clearance`; and, where a pair's relation is not known, those no farther apart than neighbours are.

The loops tried are a minimum cycle basis, so of overlapping loops the shortest are reported. A hole within one
object (a mug's handle) is no cycle of contacts and is not found.

Thesis: §2.4.2, Fig. 2.6.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, ADJACENT_GAP, BOTH, CORE_RELATIONS, ON
from lifelore.perception.clouds.nearest_points import Nearest, nearest_points
from lifelore.perception.clouds.voxel import voxelised
from lifelore.perception.contacts.interface import Interface
from lifelore.perception.scene import Scene
from lifelore.perception.topology.sight import Sight

CLEARANCE = 0.015
"""Metres: a finger's thickness. What a finger does not enter is no hole to a hand."""

MARGIN = 0.05
"""Metres of table around a loop's other objects that can be its far side."""

Node = tuple[int, int]
"""(object, number of the node in its merged network)."""


@dataclass(frozen=True, eq=False)
class Hole:
    """A loop of contact points with an opening.

    Parameters
    ----------
    objects : tuple of int
        Those the loop passes, ascending, the table included.
    nodes : tuple of (object, node)
        In the order of the loop, from its lowest node towards the lower of its two neighbours.
    size : float
        Length of the loop, metres.
    opening : float
        Smallest, over the objects, of the widest distances found along them, metres: what could pass.
    centre : (3,) float64
        Mean of the nodes, metres.
    outline : (k, 3) float64
        The border of the widest opening: along its object from contact to contact, and back on the far side.
        Contact points that face each other nearly coincide: the nodes alone enclose nothing to be drawn.
    """

    objects: tuple[int, ...]
    nodes: tuple[Node, ...]
    size: float
    opening: float
    centre: NDArray[np.float64]
    outline: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Opening:
    """Where an object and the loop's others stand apart: widest distance (metres), and border ``(k, 3)``."""

    width: float
    outline: NDArray[np.float64]


def find_holes(scene: Scene, *, clearance: float = CLEARANCE) -> tuple[Hole, ...]:
    """The holes of a scene, smallest first.

    Parameters
    ----------
    scene : Scene
    clearance : float
        Metres, > 0.
    """
    if not clearance > 0:
        raise InputError(f"clearance must be above 0 metres, got {clearance}")
    loops = contact_loops(scene, clearance=clearance)
    if not loops:
        return ()
    sight = Sight(voxelised(scene.cloud, clearance / 5), clearance / 3)
    points_of = cache(sight.cloud.of)
    holes = (_hole(scene, loop, sight, points_of, clearance) for loop in loops)
    return tuple(sorted((hole for hole in holes if hole), key=lambda hole: (hole.size, hole.nodes)))


def contact_graph(scene: Scene) -> nx.Graph:
    """All networks and the contact edges as one graph: nodes (object, number), edges with ``length`` and ``kind``.

    ``kind`` is ``network`` within an object and ``contact`` between two.
    """
    graph = nx.Graph()
    for label, network in scene.networks.items():
        at = network.positions
        graph.add_nodes_from((label, number) for number in range(len(network.nodes)))
        for i, j in np.sort(network.edges, axis=1).tolist():
            length = float(np.linalg.norm(at[i] - at[j]))
            graph.add_edge((label, i), (label, j), length=length, kind="network")
    for edge in scene.contact_edges:
        graph.add_edge((edge.a, edge.node_a), (edge.b, edge.node_b), length=edge.length, kind="contact")
    return graph


def contact_loops(scene: Scene, *, clearance: float = CLEARANCE) -> tuple[tuple[Node, ...], ...]:
    """A minimum cycle basis of `contact_graph` less the contacts that close nothing; in a fixed order.

    Whether the loops open is not asked.
    """
    ajar = {frozenset((part.a, part.b)) for part in scene.interfaces if not _closes(scene, part, clearance)}
    closed = nx.Graph()
    for x, y, length in contact_graph(scene).edges(data="length"):
        if frozenset((x[0], y[0])) not in ajar:
            # Contacts in one place count as a nanometre apart: each shortest loop visits a node once then.
            closed.add_edge(x, y, length=max(length, 1e-9))
    # A cycle lies within one biconnected part, and the search for a basis grows fast with the size of the graph.
    parts = (closed.subgraph(part) for part in nx.biconnected_components(closed) if len(part) > 2)
    loops = (loop for part in parts for loop in nx.minimum_cycle_basis(part, weight="length"))
    return tuple(sorted(map(_turned, loops)))


def _closes(scene: Scene, part: Interface, clearance: float) -> bool:
    """Whether nothing passes between the two of an interface where they are nearest."""
    known = scene.relation_of(part.a, part.b)
    if known is None or known.relation not in CORE_RELATIONS:
        return part.gap <= ADJACENT_GAP
    return known.relation in (ON, BOTH) or (known.relation == ADJACENT and part.gap <= clearance)


def _turned(loop: list[Node]) -> tuple[Node, ...]:
    """The same loop from its lowest node, towards the lower neighbour."""
    start = loop.index(min(loop))
    forward = loop[start:] + loop[:start]
    backward = [forward[0], *reversed(forward[1:])]
    return tuple(min(forward, backward))


def _hole(
    scene: Scene,
    loop: tuple[Node, ...],
    sight: Sight,
    points_of: Callable[[int], NDArray[np.float64]],
    clearance: float,
) -> Hole | None:
    openings = []
    objects = tuple(sorted({label for label, _ in loop}))
    clouds = _near_clouds({label: points_of(label) for label in objects})
    for entry, leave in _ways(loop):
        start, end = scene.position(*entry), scene.position(*leave)
        if np.linalg.norm(end - start) > clearance:
            others = np.concatenate([clouds[label] for label in objects if label != entry[0]])
            opening = opening_along(clouds[entry[0]], others, start, end, clearance, sight)
            if opening is None:
                return None
            openings.append(opening)
    if not openings:
        return None
    at = np.array([scene.position(*node) for node in loop])
    size = float(np.linalg.norm(at - np.roll(at, 1, axis=0), axis=1).sum())
    widest = max(openings, key=lambda opening: opening.width)
    return Hole(objects, loop, size, min(opening.width for opening in openings), at.mean(axis=0), widest.outline)


def _near_clouds(clouds: dict[int, NDArray[np.float64]]) -> dict[int, NDArray[np.float64]]:
    """The points of a loop's objects; of the table only what is around the others."""
    things = np.concatenate([points for label, points in clouds.items() if label != TABLE])
    if TABLE in clouds and len(things):
        table, low, high = clouds[TABLE], things.min(axis=0) - MARGIN, things.max(axis=0) + MARGIN
        clouds = clouds | {TABLE: table[((table >= low) & (table <= high)).all(axis=1)]}
    return clouds


def _ways(loop: tuple[Node, ...]) -> list[tuple[Node, Node]]:
    """For each stretch of the loop within one object, its first and its last node."""
    breaks = [k for k in range(len(loop)) if loop[k - 1][0] != loop[k][0]]
    return [(loop[first], loop[last - 1]) for first, last in zip(breaks, breaks[1:] + breaks[:1], strict=True)]


def opening_along(
    own: NDArray[np.float64],
    others: NDArray[np.float64],
    start: NDArray[np.float64],
    end: NDArray[np.float64],
    clearance: float,
    sight: Sight | None = None,
) -> Opening | None:
    """The opening between two contacts of an object; None where the rule finds none.

    Parameters
    ----------
    own, others : (n, 3), (m, 3) float64
        Points of the object and of the loop's other objects, metres.
    start, end : (3,) float64
        Where the loop enters and leaves the object, metres.
    clearance : float
        Metres, > 0; see the rule at the head of this module.
    sight : Sight, optional
        Left out, every opening counts as seen.

    Returns
    -------
    Opening or None
        Its width is the smaller of the two slices' distances.
    """
    way = end - start
    length = float(np.linalg.norm(way))
    along = way / length
    stations = np.linspace(0, length, max(int(np.ceil(2 * length / clearance)), 2) + 1)
    slices_own, slices_others = _Slices(own, (own - start) @ along), _Slices(others, (others - start) @ along)

    def nearest(x: float) -> Nearest | None:
        return nearest_points(slices_own.around(x, clearance / 2), slices_others.around(x, clearance / 2))

    ends = nearest(stations[0]), nearest(stations[-1])
    if ends[0] is None or ends[1] is None:
        return None
    least = max(ends[0].distance, ends[1].distance) + clearance
    between = [nearest(x) for x in stations[1:-1]]
    open_ = [
        f if f and f.distance >= least and (not sight or sight.is_free((f.own + f.other) / 2)) else None
        for f in between
    ]
    width = max((min(f.distance, g.distance) for f, g in pairwise(open_) if f and g), default=0.0)
    if width == 0:
        return None
    free = [f for f in open_ if f]
    border = [start, *(f.own for f in free), end, *(f.other for f in reversed(free))]
    return Opening(width, np.array(border))


class _Slices:
    """Points ``(n, 3)`` with their place along a line, ``(n,)``, sorted once for all slices."""

    def __init__(self, points: NDArray[np.float64], at: NDArray[np.float64]) -> None:
        self._points, self._at = points, at
        self._order = np.argsort(at)
        self._sorted = at[self._order]

    def around(self, x: float, half: float) -> NDArray[np.float64]:
        """The points at most `half` from `x`, in their order in the cloud."""
        first, last = np.searchsorted(self._sorted, (x - 1.001 * half, x + 1.001 * half))
        rows = np.sort(self._order[first:last])
        return self._points[rows[np.abs(self._at[rows] - x) <= half]]
