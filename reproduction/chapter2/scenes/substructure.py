"""Substructure: whether one scene's skeleton is found within another's, and where.

The skeleton of a scene: its contact points, joined within objects by the networks' edges and between objects by
contact edges. Objects are known by their role alone, so their numbers are free: two objects correspond if their
contact points do, a table only to a table. The answer comes with its witness, the objects and nodes that
correspond. Two readings of "the same network":

``edges``      every network edge of the first must be one of the second: the thesis's subgraph.
``connected``  nodes of one object must lie in one object. The minimum spanning tree of some nodes is not in
               general part of the tree of more nodes (errata E15): an object touched once more, in the middle,
               can lose the edge that the first reading asks for. Here its skeleton stays part of itself.

Contact points between unrelated neighbours (*none*) count like others; `Scene.without_unrelated_contacts` leaves
them out.

Searched by clingo with a bound on conflicts.

Thesis: §2.5, Fig. 2.10.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import networkx as nx

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.scene import Scene
from lifelore.perception.topology.holes import Node, contact_graph

MOST_CONFLICTS = 20_000
"""Bound on the solver's work: the problem is NP-complete."""
Reading = Literal["edges", "connected"]

RULES = """
{ to(X, Y) : host(Y, T) } = 1 :- part(X, T).
:- to(X, Y), to(Z, Y), X < Z.
:- join(K, X, Z), to(X, Y), not link(K, Y, V) : to(Z, V).
#show to/2.
"""


@dataclass(frozen=True)
class Substructure:
    """Whether and where a skeleton was found in another.

    Parameters
    ----------
    found : bool
        False too where the solver meets its bound before an answer.
    objects : dict of int to int
        The first scene's objects and those of the second that play their parts; empty if not found.
    nodes : dict of (object, node) to (object, node)
        The same of the contact points.
    """

    found: bool
    objects: dict[int, int]
    nodes: dict[Node, Node]


def find_substructure(part: Scene, whole: Scene, *, networks: Reading = "edges") -> Substructure:
    """A place in `whole` where the skeleton of `part` is found; the first in a fixed order of search.

    Parameters
    ----------
    part, whole : Scene
    networks : {"edges", "connected"}
        How an object's network must agree; see the head of this module.
    """
    small, large = (skeleton(scene, with_edges=networks == "edges") for scene in (part, whole))
    matched = _match(small, large)
    objects = {x[0]: y[0] for x, y in matched.items() if len(x) == 1}
    nodes = {x: y for x, y in matched.items() if len(x) == 2}
    return Substructure(bool(matched) or not len(small), objects, nodes)


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


def _match(small: nx.Graph, large: nx.Graph) -> dict[tuple, tuple]:
    """The nodes of the second that play the parts of the first; empty without an answer."""
    import clingo

    parts, hosts = sorted(small), sorted(large)
    program = (
        "\n".join(_facts(small, parts, "part", "join")) + "\n" + "\n".join(_facts(large, hosts, "host", "link"))
    )
    control = clingo.Control(["--warn=none", f"--solve-limit={MOST_CONFLICTS}"])
    control.add("base", [], RULES + program)
    control.ground([("base", [])])
    with control.solve(yield_=True) as handle:
        model = handle.model()
        if model is None:
            return {}
        pairs = sorted(tuple(end.number for end in symbol.arguments) for symbol in model.symbols(shown=True))
        return {parts[x]: hosts[y] for x, y in pairs}


def _facts(graph: nx.Graph, order: list, node_name: str, edge_name: str) -> Iterable[str]:
    number = {node: k for k, node in enumerate(order)}
    for node in order:
        yield f'{node_name}({number[node]},"{graph.nodes[node]["kind"]}").'
    for x, y, kind in graph.edges(data="kind"):
        for a, b in ((x, y), (y, x)) if edge_name == "link" else (sorted((x, y), key=number.__getitem__),):
            yield f'{edge_name}("{kind}",{number[a]},{number[b]}).'
