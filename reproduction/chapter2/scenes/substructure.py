"""Substructure: whether one scene's skeleton is found within another's, and where.

The skeleton of a scene: its contact points, joined within objects by the networks' edges and between objects by
contact edges. Objects are known by their role alone, so their numbers are free: two objects correspond if their
contact points do, a table only to a table. Two readings of "the same network":

``edges``      every network edge of the first must be one of the second: the thesis's subgraph.
``connected``  nodes of one object must lie in one object. The minimum spanning tree of some nodes is not in
               general part of the tree of more nodes (errata E15): an object touched once more, in the middle,
               can lose the edge that the first reading asks for. Here its skeleton stays part of itself.

Contact points between unrelated neighbours (*none*) count like others; `Scene.without_unrelated_contacts` leaves
them out. Thesis: §2.5, Fig. 2.10.
"""

from collections.abc import Iterator
from typing import Literal

import networkx as nx
from networkx.algorithms.isomorphism import GraphMatcher, categorical_edge_match, categorical_node_match

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.scene import Scene
from lifelore.perception.topology.holes import contact_graph

Reading = Literal["edges", "connected"]
Roles = dict[tuple[int, ...], tuple[int, ...]]
"""Objects ``(object,)`` and contact points ``(object, node)`` of a scene, and those of another in their roles."""


def substructures(part: Scene, whole: Scene, *, networks: Reading = "edges") -> Iterator[Roles]:
    """Every place in `whole` where the skeleton of `part` is found; their order means nothing.

    A symmetric scene lies in itself in several ways, all equally good.

    Parameters
    ----------
    part, whole : Scene
    networks : {"edges", "connected"}
        How an object's network must agree; see the head of this module.
    """
    small, large = (skeleton(scene, with_edges=networks == "edges") for scene in (part, whole))
    same_kind = categorical_node_match("kind", None), categorical_edge_match("kind", None)
    for found in GraphMatcher(large, small, *same_kind).subgraph_monomorphisms_iter():
        yield {own: other for other, own in found.items()}


def is_substructure(part: Scene, whole: Scene, *, networks: Reading = "edges") -> bool:
    """Whether the skeleton of `part` is found in `whole`; parameters as for `substructures`."""
    return next(substructures(part, whole, networks=networks), None) is not None


def skeleton(scene: Scene, *, with_edges: bool = True) -> nx.Graph:
    """The scene's contact points and, as nodes ``(object,)``, the objects they belong to; all with a ``kind``.

    Node kinds are ``object``, ``table`` and ``contact point``; edge kinds ``network`` (if `with_edges`),
    ``contact`` and ``of``. Objects that touch nothing are in it.
    """
    graph = nx.Graph()
    for label, network in scene.networks.items():
        graph.add_node((label,), kind="table" if label == TABLE else "object")
        for number in range(len(network.nodes)):
            graph.add_node((label, number), kind="contact point")
            graph.add_edge((label,), (label, number), kind="of")
    for x, y, kind in contact_graph(scene).edges(data="kind"):
        if with_edges or kind != "network":
            graph.add_edge(x, y, kind=kind)
    return graph
