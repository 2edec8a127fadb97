"""C2.9: whether the skeleton of a stack of three lies within that of a stack with two contacts (Figure 2.10).

Three readings of the sentence: the skeletons of the objects alone; with the ground; and of the objects alone where
a subgraph need only keep contact points of one object together (erratum E15), not every edge of its network.
"""

from collections.abc import Iterator, Mapping, Sequence

from lifelore.core.metrics import Estimate
from lifelore.perception.scene import Scene
from reproduction.chapter2.scenes.arranged_scenes import arranged
from reproduction.chapter2.scenes.scene_example import draw_examples, scene_row
from reproduction.chapter2.scenes.scene_lots import example_rows, lots, numbers_of
from reproduction.chapter2.scenes.skeletons import perceived, reading
from reproduction.chapter2.scenes.substructure import Reading, is_substructure
from reproduction.engine.estimates import exact_share

LOT = 10
READINGS: dict[str, tuple[bool, Reading]] = {
    "objects": (False, "edges"),
    "with the ground": (True, "edges"),
    "connected": (False, "connected"),
}
"""Whether the ground's contacts take part, and what of a network a subgraph keeps."""
STACK, TWO = "stack", "stack-two-contacts"
CAPTIONS = {STACK: "a stack: its skeleton is part of …", TWO: "… that of a stack with two contacts"}

rows, draw = example_rows, draw_examples


def cells(settings: Mapping) -> list[dict]:
    """Scenes in lots."""
    return lots(settings["scenes"], LOT)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """For each number, by reading: whether the stack is found in the other, and the other in the stack."""
    found, examples = [], []
    for number in numbers_of(cell, LOT, settings["scenes"]):
        scenes = {name: perceived(arranged(name, seed, number).cloud) for name in CAPTIONS}
        stack, two = scenes.values()
        found.append({"in two contacts": found_in(stack, two), "reversed": found_in(two, stack)})
        if number == 0:
            examples = [scene_row(reading(scene), CAPTIONS[name]) for name, scene in scenes.items()]
    return {"scenes": found, "examples": examples}


def found_in(part: Scene, whole: Scene) -> dict[str, bool]:
    """Whether a scene's skeleton is found in another's, by reading."""
    return {
        name: is_substructure(*(reading(scene, ground=ground) for scene in (part, whole)), networks=networks)
        for name, (ground, networks) in READINGS.items()
    }


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The same by reading."""
    for name in READINGS:
        yield {"subgraph": name}, shares(results, name)


def shares(results: Sequence[Mapping], name: str) -> dict[str, Estimate]:
    """The shares in a reading."""
    scenes = [scene for result in results for scene in result["scenes"]]
    return {
        "stack_in_two_contacts": exact_share(scene["in two contacts"][name] for scene in scenes),
        "two_contacts_in_stack": exact_share(scene["reversed"][name] for scene in scenes),
    }
