"""A scene as a graph of objects and relations in the DOT language of Graphviz."""

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import NONE, SYMMETRIC
from lifelore.perception.scene import Scene, object_name


def to_dot(scene: Scene, min_confidence: float = 0.0) -> str:
    """The relations as a DOT document; symmetric ones without arrow heads, ones below 0.5 dashed.

    *none* and relations below `min_confidence` are left out. Lines stand in the order of the objects' numbers, so
    equal scenes give equal text.
    """
    related = [r for r in scene.relations if r.relation != NONE and r.confidence >= min_confidence]
    lines = ["digraph scene {", "  rankdir=BT;", "  node [shape=ellipse];"]
    for label in sorted({*scene.objects, *(TABLE for r in related if TABLE in (r.a, r.b))}):
        shape = " shape=box" if label == TABLE else ""
        lines.append(f"  n{label} [label={quoted(object_name(label))}{shape}];")
    for r in sorted(related, key=lambda r: (r.a, r.b, r.relation)):
        text = quoted(f"{r.relation} {r.confidence:.2f}")
        arrow = " dir=none constraint=false" if r.relation in SYMMETRIC | scene.words.symmetric else ""
        style = " style=dashed" if r.confidence < 0.5 else ""
        lines.append(f"  n{r.a} -> n{r.b} [label={text}{arrow}{style}];")
    return "\n".join([*lines, "}", ""])


def quoted(text: str) -> str:
    """A DOT string: in double quotes, with quotes, backslashes and line ends escaped."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\r", "").replace("\n", "\\n")
    return f'"{escaped}"'
