"""Cells of claim C2.9: whether the skeleton of a stack of three lies within the skeletons of other scenes.

Each scene has three skeletons: of the *things* alone (related pairs), the same with the *ground*, and of *support*
(pairs in which one object carries the other, ground included). A skeleton has no predicates, so a row of three
neighbours has the skeleton of a stack; only the skeleton of support differs. Thesis: Figure 2.10.
"""

from collections.abc import Mapping
from typing import Any

from lifelore.core.labelled_cloud import TABLE
from lifelore.perception.scene import Scene
from lifelore.perception.topology.substructure import find_substructure
from reproduction.chapter2.scenes.arranged_scenes import arranged
from reproduction.chapter2.scenes.scene_example import scene_row
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of, uses_real
from reproduction.chapter2.scenes.skeletons import RELATED, SUPPORT, perceived, reading, real_stacks

LOT = 10
READINGS = {"things": (RELATED, False), "ground": (RELATED, True), "support": (SUPPORT, True)}
HOSTS = ("two contacts", "two things", "row", "two on one")
ARRANGEMENTS = dict(zip(HOSTS, ("stack-two-contacts", "no-hole", "row", "two-on-one"), strict=True))


def cells(settings: Mapping) -> list[dict]:
    """Scenes in lots; then the real stacks, where the settings ask for them and they are there."""
    return lots(settings["scenes"], LOT) + ([{"real": True}] if uses_real(settings) else [])


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """For each number: in which scenes the stack's skeleton was found, and whether the witness is right."""
    if cell.get("real"):
        host = perceived(arranged(ARRANGEMENTS["two contacts"], seed, 0).cloud)
        scenes = [{"two contacts": found_in(perceived(three.cloud), host)} for three in real_stacks()]
        return {"real": True, "scenes": scenes, "examples": []}
    rows, examples = [], []
    for number in numbers_of(cell, LOT, settings["scenes"]):
        stack = perceived(arranged("stack", seed, number).cloud)
        hosts = {name: perceived(arranged(ARRANGEMENTS[name], seed, number).cloud) for name in HOSTS}
        row: dict[str, Any] = {name: found_in(stack, host) for name, host in hosts.items()}
        row["reversed"] = found_in(hosts["two contacts"], stack)
        row["witness"] = witness_is_right(stack, hosts["two contacts"])
        rows.append(row)
        if number == 0:
            pictures = {"stack": stack, "two contacts": hosts["two contacts"], "row": hosts["row"]}
            examples = [scene_row(reading(scene), name) for name, scene in pictures.items()]
    return {"real": False, "scenes": rows, "examples": examples}


def found_in(part: Scene, whole: Scene) -> dict[str, bool]:
    """Whether a scene's skeleton is found in another's, by reading; of the things also as *connected*."""
    found = {}
    for name, (words, ground) in READINGS.items():
        small, large = (reading(scene, words, ground=ground) for scene in (part, whole))
        found[name] = find_substructure(small, large).found
        if name == "things":
            found["connected"] = find_substructure(small, large, networks="connected").found
    return found


def witness_is_right(part: Scene, whole: Scene) -> bool | None:
    """Whether the witness maps each object and the ground to its counterpart; None where none is found."""
    witness = find_substructure(*(reading(scene, ground=True) for scene in (part, whole)))
    if not witness.found:
        return None
    return witness.objects == {label: label for label in (TABLE, *part.objects)}
