"""Prints the relations of a perceived scene as a table."""

from collections.abc import Mapping, Sequence


def print_scene(document: Mapping, written: Sequence[str]) -> None:
    """Print the document of a perceived scene, without pairs that have relation *none*."""
    from rich.console import Console
    from rich.table import Table

    stated = [relation for relation in document["relations"] if relation["relation"] != "none"]
    table = Table("a", "relation", "b", "confidence", "gap, mm")
    for relation in stated:
        gap = "" if relation["gap"] is None else f"{1000 * relation['gap']:.0f}"
        table.add_row(
            str(relation["a"]), relation["relation"], str(relation["b"]), f"{relation['confidence']:.2f}", gap
        )
    console = Console()
    if stated:
        console.print(table)
    n_objects, n_holes = len(document["objects"]), len(document["holes"])
    console.print(f"{_many(n_objects, 'object')}, {_many(n_holes, 'hole')}, {document['seconds']:.2f} s")
    for warning in document["warnings"]:
        console.print(f"warning: {warning['message']}", highlight=False, soft_wrap=True, markup=False)
    for path in written:
        console.print(f"written: {path}", highlight=False, soft_wrap=True)


def _many(n: int, noun: str) -> str:
    return f"{n} {noun}{'' if n == 1 else 's'}"
