"""C2.7: skeletons of stacks of three, of two objects segmented into three, and of controls.

Findings are of three objects of each scene: the middle one and its two neighbours. *stack*: three blocks (thesis
Fig. 2.7, left). *cut*: a block on a slab or a ball on a block, of which one is cut level into two (right).
Controls: a *row* of three neighbours, and *two on one*. *real stack*, *real cut*: the same of real scenes with
other objects removed. Thesis: §2.4.3.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.metrics import Estimate
from lifelore.core.relations import ON
from lifelore.core.streams import stream
from lifelore.perception.scene import Scene
from reproduction.chapter2.scenes.arranged_scenes import arranged
from reproduction.chapter2.scenes.perturbation import cut_object, only
from reproduction.chapter2.scenes.real_scenes import real_scenes
from reproduction.chapter2.scenes.scene_example import draw_examples, scene_row
from reproduction.chapter2.scenes.scene_lots import example_rows, lots, numbers_of, uses_real
from reproduction.chapter2.scenes.skeletons import carried_pairs, perceived, predicates, reading, standing
from reproduction.engine.estimates import exact_share
from reproduction.engine.records import having, nested

KINDS = ("stack", "cut", "row", "two-on-one")
REAL = ("real stack", "real cut")
LOT = 15
LOW_CUT, HIGH_CUT = 0.35, 0.65
"""Where an object is cut, of its visible height."""
CAPTIONS = {"stack": "three objects", "cut": "two objects, segmented into three"}
TALL = 0.04
"""Metres: the lower of two real objects is cut if its visible height reaches this, else the upper."""

rows, draw = example_rows, draw_examples


class Three(NamedTuple):
    """A cloud and the labels of three of its objects: the lowest, the middle and the highest of a stack."""

    cloud: LabelledCloud
    below: int
    middle: int
    above: int


def real_stacks() -> Iterator[Three]:
    """Every c on b on a of the real scenes, by the hand-made labels; other objects are removed."""
    for scene in real_scenes():
        on = carried_pairs(scene.truth)
        for above, middle in sorted(on):
            for below in sorted(b for a, b in on if a == middle):
                yield Three(only(scene.cloud, (below, middle, above)), below, middle, above)


def cells(settings: Mapping) -> list[dict]:
    """Scenes in lots, by kind; then the real ones, where the settings ask for them and they are there."""
    real = [{"kind": kind} for kind in REAL] if uses_real(settings) else []
    return [lot for kind in KINDS for lot in lots(settings["scenes"], LOT, kind=kind)] + real


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Findings of a lot, and a picture from the first lot of the thesis's two kinds."""
    if cell["kind"] in REAL:
        threes = real_stacks() if cell["kind"] == REAL[0] else real_cuts(seed)
    else:
        threes = (simulated(cell["kind"], seed, n) for n in numbers_of(cell, LOT, settings["scenes"]))
    rows, examples = [], []
    for number, three in enumerate(threes):
        scene = perceived(three.cloud)
        rows.append(findings(scene, three))
        if number == 0 and cell.get("first") == 0 and cell["kind"] in CAPTIONS:
            examples.append(scene_row(reading(scene), CAPTIONS[cell["kind"]]))
    return {"kind": cell["kind"], "scenes": rows, "examples": examples}


def simulated(kind: str, seed: int, number: int) -> Three:
    """Scene `number` of one of `KINDS`."""
    if kind != "cut":
        return Three(arranged(kind, seed, number).cloud, *((3, 2, 4) if kind == "two-on-one" else (2, 3, 4)))
    rng = stream(seed, "cut level", number)
    if number % 2:
        cloud, upper = level_cut(arranged("ball-on-block", seed, number).cloud, 2, rng)
        return Three(cloud, 2, upper, 3)
    cloud, upper = level_cut(arranged("no-hole", seed, number).cloud, 3, rng)
    return Three(cloud, 2, 3, upper)


def level_cut(cloud: LabelledCloud, label: int, rng: np.random.Generator) -> tuple[LabelledCloud, int]:
    """An object cut by a level plane near the middle of its visible height, and its upper part's label."""
    heights = cloud.of(label)[:, 2]
    low, high = np.quantile(heights, [0.01, 0.99])
    at = low + rng.uniform(LOW_CUT, HIGH_CUT) * (high - low)
    return cut_object(cloud, label, (0.0, 0.0, 1.0), (0.0, 0.0, at))


def real_cuts(seed: int) -> Iterator[Three]:
    """Every b on a of the real scenes with a on the table, one of the two cut level."""
    for scene in real_scenes():
        on_table = standing(scene.truth)
        for upper, lower in sorted(pair for pair in carried_pairs(scene.truth) if pair[1] in on_table):
            rng = stream(seed, "cut level", scene.name, upper, lower)
            cloud = only(scene.cloud, (lower, upper))
            tall = bool(np.ptp(np.quantile(cloud.of(lower)[:, 2], [0.01, 0.99])) >= TALL)
            cloud, part = level_cut(cloud, lower if tall else upper, rng)
            yield Three(cloud, lower, part, upper) if tall else Three(cloud, lower, upper, part)


def findings(scene: Scene, three: Three) -> dict:
    """Whether the middle one has two contact points towards related objects, and whether the three are a stack.

    A stack has the skeleton of one, two and one points, see `is_path`, and its predicates are *on* twice.
    """
    related = reading(scene)
    stacked = predicates(related) == {(ON, three.above, three.middle), (ON, three.middle, three.below)}
    return {
        "two_points": len(related.networks[three.middle].nodes) == 2,
        "stack": is_path(related, three) and stacked,
    }


def is_path(scene: Scene, three: Three) -> bool:
    """Whether the networks have 1, 2 and 1 points and either point of the middle faces one neighbour."""
    counts = [len(scene.networks[label].nodes) for label in (three.below, three.middle, three.above)]
    faced = dict(
        (edge.node_a, edge.b) if edge.a == three.middle else (edge.node_b, edge.a)
        for edge in scene.contact_edges
        if three.middle in (edge.a, edge.b)
    )
    two_edges = len(scene.contact_edges) == 2
    return counts == [1, 2, 1] and two_edges and set(faced.values()) == {three.below, three.above}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares by kind of two points in the middle, and of the stack's structure."""
    every, found = nested(results, "scenes", ("kind",)), {}
    for kind in (*KINDS, *REAL):
        scenes, name = having(every, kind=kind), kind.replace(" ", "_").replace("-", "_")
        found[f"structure_{name}"] = exact_share(scene["stack"] for scene in scenes)
        found[f"two_points_{name}"] = exact_share(scene["two_points"] for scene in scenes)
    return found
