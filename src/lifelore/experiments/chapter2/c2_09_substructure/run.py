"""Whether the skeleton of a stack of three lies within that of a stack with two contacts, and within others.

Three skeletons of each scene are looked at: of the *things* alone (related pairs), the same with the *ground*,
and of *support* (pairs of which one carries the other, ground included): a skeleton has no predicates, so a row
of three neighbours has that of a stack, and only what carries what tells them apart.
"""

from collections.abc import Mapping
from typing import Any

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.experiments.chapter2.arranged_scenes import arranged
from lifelore.experiments.chapter2.real_scenes import real_scenes_folder
from lifelore.experiments.chapter2.scene_example import scene_row
from lifelore.experiments.chapter2.skeleton_reading import RELATED, SUPPORT, perceived, reading
from lifelore.experiments.chapter2.stack_skeletons import real_stacks
from lifelore.perception.scene import Scene
from lifelore.perception.topology.substructure import find_substructure

LOT = 10
READINGS = {"things": (RELATED, False), "ground": (RELATED, True), "support": (SUPPORT, True)}
HOSTS = ("two contacts", "two things", "row", "two on one")
ARRANGEMENTS = dict(zip(HOSTS, ("stack-two-contacts", "no-hole", "row", "two-on-one"), strict=True))


def cells(settings: Mapping) -> list[dict]:
    """Scenes in lots; then the real stacks, where asked for and there."""
    lots = [{"first": k} for k in range(0, settings["scenes"], LOT)]
    return [*lots, {"real": True}] if settings["real"] and real_scenes_folder() else lots


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """For each number: in which scenes the stack's skeleton was found, which way round, and with what witness."""
    if cell.get("real"):
        host = perceived(arranged(ARRANGEMENTS["two contacts"], seed, 0).cloud)
        stacks = [perceived(three.cloud) for three in real_stacks()]
        return {
            "real": True,
            "scenes": [{"two contacts": found_in(stack, host)} for stack in stacks],
            "examples": [],
        }
    rows, examples = [], []
    for number in range(cell["first"], min(cell["first"] + LOT, settings["scenes"])):
        stack = perceived(arranged("stack", seed, number).cloud)
        hosts = {name: perceived(arranged(ARRANGEMENTS[name], seed, number).cloud) for name in HOSTS}
        row: dict[str, Any] = {name: found_in(stack, host) for name, host in hosts.items()}
        row["reversed"] = found_in(hosts["two contacts"], stack)
        row["witness"] = witness_is_right(stack, hosts["two contacts"])
        row["points"] = [sum(len(n.nodes) for n in reading(s).networks.values()) for s in (stack, *hosts.values())]
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
    """Whether the witness maps each thing, the ground too, to the one in its place; None where none is found."""
    witness = find_substructure(*(reading(scene, ground=True) for scene in (part, whole)))
    if not witness.found:
        return None
    return witness.objects == {label: label for label in (TABLE, *part.objects)}


def check(settings: Mapping) -> None:
    if settings["scenes"] < 1:
        raise InputError(f"scenes must be at least 1, got {settings['scenes']}")
