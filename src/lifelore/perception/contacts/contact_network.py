"""Contact point networks: the contact points of an object, joined by a minimum spanning tree.

The edges are those of the minimum weighted spanning tree over the contact points, weights Euclidean (thesis
§2.3.4). To merge the networks of one object towards several others, the tree is built over all their points
(§2.3.6).
"""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from lifelore.perception.contacts.contact_points import ContactPoint


@dataclass(frozen=True, eq=False)
class ContactPointNetwork:
    """The skeleton of one object as it is used in this scene.

    Parameters
    ----------
    object_id : int
    nodes : tuple of ContactPoint
    edges : (m, 2) int64
        Pairs of node numbers, a spanning tree: m is one less than the number of nodes (0 for none).

    Examples
    --------
    >>> from lifelore.perception import contact_networks
    >>> plane = np.stack(np.meshgrid(np.linspace(0, 0.1, 20), np.linspace(0, 0.1, 20)), -1).reshape(-1, 2)
    >>> lower, upper = (np.column_stack([plane, np.full(400, height)]) for height in (0.0, 0.01))
    >>> network, _ = contact_networks(upper, lower)
    >>> len(network.nodes), network.positions.shape
    (1, (1, 3))
    """

    object_id: int
    nodes: tuple[ContactPoint, ...]
    edges: NDArray[np.int64]

    @classmethod
    def from_contacts(cls, object_id: int, contacts: Iterable[ContactPoint]) -> "ContactPointNetwork":
        """The network over `contacts`: nodes as given, edges by the minimum spanning tree."""
        nodes = tuple(contacts)
        return cls(object_id, nodes, spanning_edges(np.array([n.position for n in nodes]).reshape(-1, 3)))

    @property
    def positions(self) -> NDArray[np.float64]:
        """Positions of the nodes, shape ``(k, 3)``, metres."""
        return np.array([node.position for node in self.nodes]).reshape(-1, 3)


def spanning_edges(positions: NDArray[np.float64]) -> NDArray[np.int64]:
    """Edges of the Euclidean minimum spanning tree, ``(k - 1, 2)``, each row ascending, rows in order.

    Points at the same position are joined by an edge of length 0. Of equally short edges, those of the
    point that comes first in the order 1, 0, 2, 3, … are taken first, as in networkx.
    """
    n = len(positions)
    if n < 2:
        return np.empty((0, 2), np.int64)
    apart = positions[:, None] - positions
    distance = np.sqrt(apart[..., 0] ** 2 + apart[..., 1] ** 2 + apart[..., 2] ** 2).tolist()
    tree = list(range(n))
    edges = []
    for edge in sorted(combinations([1, 0, *range(2, n)], 2), key=lambda pair: distance[pair[0]][pair[1]]):
        root, other_root = tree[edge[0]], tree[edge[1]]
        if root != other_root:
            tree = [root if part == other_root else part for part in tree]
            edges.append(sorted(edge))
    return np.array(sorted(edges), np.int64)
