"""C2.10: a ball A on a block B on the ground G (thesis Fig. 2.2), simulated and real."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.metrics import Estimate
from lifelore.core.relations import ON
from lifelore.domains.tabletop.settings import TabletopSettings
from reproduction.chapter2.scenes.arranged_scenes import arranged
from reproduction.chapter2.scenes.perturbation import only
from reproduction.chapter2.scenes.real_scenes import real_scenes
from reproduction.chapter2.scenes.scene_example import draw_examples, scene_row
from reproduction.chapter2.scenes.scene_lots import example_rows, lots, numbers_of, uses_real
from reproduction.chapter2.scenes.skeletons import carried_pairs, perceived, predicates, reading, standing
from reproduction.engine.estimates import exact_share

LOT = 10
BLOCK, BALL = 2, 3
CAMERAS = ("stereo", "kinect")

rows, draw = example_rows, draw_examples


def cells(settings: Mapping) -> list[dict]:
    """Lots by camera; then the real scenes at once, where the settings ask for them and they are there."""
    real = [{"camera": "real"}] if uses_real(settings) else []
    return [lot for camera in CAMERAS for lot in lots(settings["scenes"], LOT, camera=camera)] + real


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Findings of a lot, and a picture from the first lot of the first camera."""
    camera = cell["camera"]
    if camera == "real":
        return {"camera": camera, "scenes": real_findings(), "examples": []}
    drawn = replace(TabletopSettings(), camera=camera)
    rows, examples = [], []
    for number in numbers_of(cell, LOT, settings["scenes"]):
        cloud = arranged("ball-on-block", seed, number, drawn).cloud
        rows.append(findings(cloud, BALL, BLOCK))
        if number == 0 and camera == CAMERAS[0]:
            examples.append(
                scene_row(reading(perceived(cloud), ground=True), f"ball A, block B, ground G: {rows[-1]['said']}")
            )
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
    `two_points`: whether the lower object has one contact point towards the upper and one towards the ground.
    """
    scene = perceived(cloud)
    names = {upper: "A", lower: "B", TABLE: "G"}
    nodes = reading(scene, ground=True).networks[lower].nodes
    return {
        "said": ", ".join(sorted(f"{word}({names[a]}, {names[b]})" for word, a, b in predicates(scene))),
        "right": predicates(scene) == {(ON, upper, lower), (ON, lower, TABLE)},
        "two_points": sorted(node.other for node in nodes) == sorted((upper, TABLE)),
    }


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of scenes with right predicates and two points, by the first camera and of real scenes."""
    real = {f"{name}_of_real": number for name, number in shares(results, "real").items()}
    return shares(results, CAMERAS[0]) | real


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The same by camera."""
    for camera in CAMERAS:
        yield {"camera": camera}, shares(results, camera)


def shares(results: Sequence[Mapping], camera: str) -> dict[str, Estimate]:
    """The shares of a camera's scenes."""
    scenes = [scene for result in results if result["camera"] == camera for scene in result["scenes"]]
    return {
        "predicates_right": exact_share(scene["right"] for scene in scenes),
        "two_points_of_the_block": exact_share(scene["two_points"] for scene in scenes),
    }
