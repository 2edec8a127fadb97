"""Cells of claim C2.10: a ball A on a block B on the ground G (thesis Fig. 2.2), simulated and real."""

from collections.abc import Mapping
from dataclasses import replace

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import ON
from lifelore.domains.tabletop.settings import TabletopSettings
from reproduction.chapter2.scenes.arranged_scenes import arranged
from reproduction.chapter2.scenes.real_scenes import real_scenes
from reproduction.chapter2.scenes.scene_example import scene_row
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of, uses_real
from reproduction.chapter2.scenes.skeletons import (
    NEAR,
    carried_pairs,
    only,
    perceived,
    predicates,
    reading,
    standing,
)

LOT = 10
BLOCK, BALL = 2, 3
CAMERAS = ("kinect", "stereo")


def cells(settings: Mapping) -> list[dict]:
    """Lots by camera; then the real scenes at once, where the settings ask for them and they are there."""
    real = [{"camera": "real"}] if uses_real(settings) else []
    return [lot for camera in CAMERAS for lot in lots(settings["scenes"], LOT, camera=camera)] + real


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Findings of a lot, and a picture from the first lot of each camera."""
    camera = cell["camera"]
    if camera == "real":
        return {"camera": camera, "scenes": real_findings(), "examples": []}
    drawn = replace(TabletopSettings(), camera=camera)
    rows, examples = [], []
    for number in numbers_of(cell, LOT, settings["scenes"]):
        cloud = arranged("ball-on-block", seed, number, drawn).cloud
        rows.append(findings(cloud, BALL, BLOCK))
        if number == 0:
            examples.append(scene_row(reading(perceived(cloud), ground=True), f"{camera}: {rows[-1]['said']}"))
    return {"camera": camera, "scenes": rows, "examples": examples}


def real_findings() -> list[dict]:
    """Of every object on a single object on the table, by the hand-made labels; other objects are removed."""
    found = []
    for scene in real_scenes():
        pairs, on_table = carried_pairs(scene.truth), standing(scene.truth)
        for upper, lower in sorted(pairs):
            if lower in on_table and sum(a == upper for a, _ in pairs) == 1:
                found.append(findings(only(scene.cloud, (upper, lower)), upper, lower))
    return found


def findings(cloud: LabelledCloud, upper: int, lower: int) -> dict:
    """The predicates of two objects and the ground, and the contact points of their networks.

    `said`: the predicates as text; `right`: whether they are on(upper, lower) and on(lower, table) and no other;
    `points`: of the lower object towards the upper and the ground, `upper_points`: of the upper object towards all
    its related objects, `near_points`: the same of all near pairs.
    """
    scene = perceived(cloud)
    names = {upper: "A", lower: "B", TABLE: "G"}
    networks = reading(scene, ground=True).networks
    return {
        "said": ", ".join(sorted(f"{word}({names[a]}, {names[b]})" for word, a, b in predicates(scene))),
        "right": predicates(scene) == {(ON, upper, lower), (ON, lower, TABLE)},
        "points": [sum(node.other == other for node in networks[lower].nodes) for other in (upper, TABLE)],
        "upper_points": len(networks[upper].nodes),
        "near_points": len(reading(scene, NEAR, ground=True).networks[upper].nodes),
    }
