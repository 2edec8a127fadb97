"""Cells of claim C2.13: a ball on top of an L-block's upright (thesis Fig. 2.1), and pairs to learn from.

Scenes and lessons are rows of `tabletop_pairs`: contacts under a grid of kernels, none dropped, features, and the
descriptors of peers. Block and ball have the labels 2 and 3; the table's points are left out.
"""

from collections.abc import Mapping
from dataclasses import replace

from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS, interfaces
from lifelore.perception.scene import Scene
from reproduction.chapter2.scenes import tabletop_pairs
from reproduction.chapter2.scenes.arranged_scenes import arranged
from reproduction.chapter2.scenes.perturbation import without_table
from reproduction.chapter2.scenes.scene_example import scene_row
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of
from reproduction.chapter2.scenes.tabletop_pairs import STANDARD, Row, loose_settings, pair_rows
from reproduction.chapter2.scoring.pair_validation import THRESHOLD

BLOCK, BALL = 2, 3
LOT = 15
LESSON, SCENE = "lesson", "scene"
NODES = 3
"""Of the L-block in the thesis's figure, without the threshold."""


def cells(settings: Mapping) -> list[dict]:
    """Lots of lessons, then of scenes, camera by camera."""
    sizes = ((LESSON, settings["lessons"], tabletop_pairs.LOT), (SCENE, settings["scenes"], LOT))
    return [
        lot
        for camera in settings["cameras"]
        for kind, n, size in sizes
        for lot in lots(n, size, kind=kind, camera=camera)
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The rows of a lot, ``{"kind", "camera", "rows", "examples"}``; pictures from the first lot of scenes."""
    kind, camera, first = cell["kind"], cell["camera"], cell["first"]
    head = {"kind": kind, "camera": camera}
    if kind == LESSON:
        asked = {"pairs": settings["lessons"], "camera": camera}
        found = tabletop_pairs.run_cell(asked, {"data_set": 0, "first": first}, seed)
        return {**head, "rows": found["rows"], "examples": []}
    drawn = replace(TabletopSettings(), camera=camera)
    worlds = [arranged("ball-at-l-block", seed, k, drawn) for k in numbers_of(cell, LOT, settings["scenes"])]
    rows = [row for world in worlds for row in pair_rows(world.name, world.cloud, world.truth)]
    examples = pictures(worlds, rows) if first == 0 else []
    return {**head, "rows": rows, "examples": examples}


def pictures(worlds: list[TabletopScene], rows: list[Row]) -> list[dict]:
    """The scene whose block comes nearest to the thesis's number of nodes: every contact, and strong ones."""
    at = min(range(len(rows)), key=lambda k: abs(len(rows[k]["contacts"][STANDARD]["a"]) - NODES))
    world = next(world for world in worlds if world.name == rows[at]["scene"])
    found = []
    for words, settings in (
        ("every contact", loose_settings(DEFAULT_CONTACT_SETTINGS.length, DEFAULT_CONTACT_SETTINGS.cost)),
        (f"of at least {THRESHOLD}", DEFAULT_CONTACT_SETTINGS),
    ):
        between = interfaces(without_table(world.cloud), settings)
        n = len(between[0].contacts_a)
        caption = f"{words}: {n} node{'s' * (n != 1)}"
        found.append(scene_row(Scene(world.cloud, between), caption))
    return found
