"""A ball A on a block B on the ground G (thesis Fig. 2.2): predicates and networks, simulated and real."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import ON
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.experiments.chapter2.arranged_scenes import arranged
from lifelore.experiments.chapter2.real_scenes import real_scenes, real_scenes_folder
from lifelore.experiments.chapter2.scene_example import scene_row
from lifelore.experiments.chapter2.skeleton_reading import NEAR, only, perceived, predicates, reading
from lifelore.experiments.chapter2.stack_skeletons import carried_pairs

LOT = 10
BLOCK, BALL = 2, 3
CAMERAS = ("kinect", "stereo")


def cells(settings: Mapping) -> list[dict]:
    """Lots by camera; then the real scenes at once, where asked for and there."""
    lots = [{"camera": camera, "first": k} for camera in CAMERAS for k in range(0, settings["scenes"], LOT)]
    return [*lots, {"camera": "real"}] if settings["real"] and real_scenes_folder() else lots


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Findings of a lot, and a picture from the first lot of each camera."""
    camera = cell["camera"]
    if camera == "real":
        return {"camera": camera, "scenes": real_findings(), "examples": []}
    drawn = replace(TabletopSettings(), camera=camera)
    rows, examples = [], []
    for number in range(cell["first"], min(cell["first"] + LOT, settings["scenes"])):
        cloud = arranged("ball-on-block", seed, number, drawn).cloud
        rows.append(findings(cloud, BALL, BLOCK))
        if number == 0:
            examples.append(scene_row(reading(perceived(cloud), ground=True), f"{camera}: {rows[-1]['said']}"))
    return {"camera": camera, "scenes": rows, "examples": examples}


def real_findings() -> list[dict]:
    """Of every thing that lies on one thing on the table, by people's labels; other things taken away."""
    found = []
    for scene in real_scenes():
        pairs = carried_pairs(scene.truth)
        standing = {label.a for label in scene.truth if label.relation == ON and label.b == TABLE}
        for upper, lower in sorted(pairs):
            if lower in standing and sum(a == upper for a, _ in pairs) == 1:
                found.append(findings(only(scene.cloud, (upper, lower)), upper, lower))
    return found


def findings(cloud: LabelledCloud, upper: int, lower: int) -> dict:
    """What is said of the two things and the ground, and the points of the lower thing's network.

    `said`: the predicates as text; `right`: whether they are on(upper, lower) and on(lower, table) and no other;
    `points`: of the lower thing towards the upper and the ground, `upper_points`: of the upper thing towards all
    it is related to, `near_points`: the same of all near pairs; `apart`: between the first two, mm.
    """
    scene = perceived(cloud)
    names = {upper: "A", lower: "B", TABLE: "G"}
    network, above = reading(scene, ground=True).networks[lower], reading(scene, ground=True).networks[upper]
    towards = {other: [n.position for n in network.nodes if n.other == other] for other in (upper, TABLE)}
    apart = [np.linalg.norm(a - b) for a in towards[upper][:1] for b in towards[TABLE][:1]]
    return {
        "said": ", ".join(sorted(f"{word}({names[a]}, {names[b]})" for word, a, b in predicates(scene))),
        "right": predicates(scene) == {(ON, upper, lower), (ON, lower, TABLE)},
        "points": [len(towards[upper]), len(towards[TABLE])],
        "upper_points": len(above.nodes),
        "near_points": len(reading(scene, NEAR, ground=True).networks[upper].nodes),
        "apart": round(1000 * float(apart[0]), 1) if apart else None,
    }


def check(settings: Mapping) -> None:
    if settings["scenes"] < 1:
        raise InputError(f"scenes must be at least 1, got {settings['scenes']}")
