"""Prints the relations of a perceived scene as a table."""

from collections.abc import Iterator, Mapping, Sequence

from rich.console import Console
from rich.table import Table


def print_scene(document: Mapping, written: Sequence[str]) -> None:
    """Print the document of a perceived scene, without pairs that have relation *none*."""
    stated = [relation for relation in document["relations"] if relation["relation"] != "none"]
    table = Table("a", "relation", "b", "confidence", "gap, mm")
    for relation in stated:
        gap = "" if relation["gap"] is None else f"{1000 * relation['gap']:.0f}"
        table.add_row(
            str(relation["a"]), relation["relation"], str(relation["b"]), f"{relation['confidence']:.2f}", gap
        )
    console = Console(highlight=False, soft_wrap=True, markup=False)
    if stated:
        console.print(table, soft_wrap=False)
    n_objects, n_holes = len(document["objects"]), len(document["holes"])
    console.print(f"{_many(n_objects, 'object')}, {_many(n_holes, 'hole')}, {document['seconds']:.2f} s")
    hidden = [one["fact"] for one in document["unknown"] if one["reason"] == "hidden"]
    if hidden:
        console.print(f"unknown, since other objects hide a part of the top: {', '.join(hidden)}")
    for line in _plan_lines(document["plan"]) if "plan" in document else ():
        console.print(line)
    for warning in document["warnings"]:
        console.print(f"warning: {warning['message']}")
    for path in written:
        console.print(f"written: {path}")


def _plan_lines(plan: Mapping) -> Iterator[str]:
    if plan["reason"] is not None:
        yield f"no plan: {plan['reason']}"
    elif not plan["steps"]:
        yield "no step is needed: the goal holds already"
    else:
        yield f"plan with a confidence of {plan['confidence']:.2f}; places of the centres as x, y, z in m:"
        for number, step in enumerate(plan["steps"], start=1):
            objects = ", ".join(_placed(one) for one in step["objects"])
            look = (
                f"; look first whether anything rests on {', '.join(map(str, step['look']))}"
                if step["look"]
                else ""
            )
            yield f"{number}. {step['action']} {objects}: confidence {step['confidence']:.2f}{look}"


def _placed(one: Mapping) -> str:
    """An object of a step with its place, unless an earlier step has moved it."""
    if one["moved"]:
        return str(one["id"])
    frames = [("", one["centroid"]), ("camera's frame ", one.get("centroid_camera"))]
    return f"{one['id']} at {'; '.join(f'{name}({_xyz(place)})' for name, place in frames if place is not None)}"


def _xyz(place: Sequence[float]) -> str:
    return ", ".join(f"{x:.3f}" for x in place)


def _many(n: int, noun: str) -> str:
    return f"{n} {noun}{'' if n == 1 else 's'}"
