"""A scene as a graph of objects and relations: for networkx, and in the DOT language of Graphviz."""

from typing import TYPE_CHECKING

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import NONE, SYMMETRIC
from lifelore.perception.scene import Scene, object_name

if TYPE_CHECKING:
    import networkx as nx


def relation_graph(scene: Scene, min_confidence: float = 0.0) -> "nx.MultiDiGraph":
    """Objects and relations as a directed multigraph; *none* and relations below a confidence are left out.

    Nodes are the scene's numbers (the table's is 1, present if a relation names it) with ``name``, ``n_points``
    and ``centroid``; edges run from a to b and have ``relation``, ``confidence``, ``gap`` and ``symmetric``.
    """
    import networkx as nx

    graph = nx.MultiDiGraph()
    related = [r for r in scene.relations if r.relation != NONE and r.confidence >= min_confidence]
    for label in sorted({*scene.objects, *(TABLE for r in related if TABLE in (r.a, r.b))}):
        points = scene.cloud.of(label)
        centroid = tuple(points.mean(axis=0).tolist()) if len(points) else None
        graph.add_node(label, name=object_name(label), n_points=len(points), centroid=centroid)
    for r in sorted(related, key=lambda r: (r.a, r.b, r.relation)):
        fields = {"relation": r.relation, "confidence": r.confidence, "gap": r.gap}
        graph.add_edge(r.a, r.b, symmetric=r.relation in SYMMETRIC | scene.words.symmetric, **fields)
    return graph


def to_dot(scene: Scene, min_confidence: float = 0.0) -> str:
    """The relations as a DOT document; symmetric ones without arrow heads, ones below 0.5 dashed.

    Lines stand in the order of the objects' numbers, so equal scenes give equal text.
    """
    graph = relation_graph(scene, min_confidence)
    lines = ["digraph scene {", "  rankdir=BT;", "  node [shape=ellipse];"]
    for label, fields in graph.nodes(data=True):
        shape = " shape=box" if label == TABLE else ""
        lines.append(f"  n{label} [label={quoted(fields['name'])}{shape}];")
    for a, b, fields in graph.edges(data=True):
        text = quoted(f"{fields['relation']} {fields['confidence']:.2f}")
        arrow = " dir=none constraint=false" if fields["symmetric"] else ""
        style = " style=dashed" if fields["confidence"] < 0.5 else ""
        lines.append(f"  n{a} -> n{b} [label={text}{arrow}{style}];")
    return "\n".join([*lines, "}", ""])


def quoted(text: str) -> str:
    """A DOT string: in double quotes, with quotes, backslashes and line ends escaped."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\r", "").replace("\n", "\\n")
    return f'"{escaped}"'
