"""C2.8: one object wrongly segmented into two, and the relation of its parts (thesis Fig. 2.9).

An object that stands on the table by itself is cut *level* (its upper part is on its lower) or *upright* (its
parts stand side by side). Parts of an upright cut must both reach the table, else one would hang from the other.
"""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.metrics import Estimate
from lifelore.core.relations import ADJACENT, BOTH, NONE, ON, PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.photograph import FIRST_OBJECT
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop.tabletop import sample_scene
from lifelore.perception.relations.relation import Relation
from lifelore.perception.scene import Scene
from reproduction.chapter2.scenes.perturbation import cut_object
from reproduction.chapter2.scenes.real_scenes import real_scenes
from reproduction.chapter2.scenes.scene_example import draw_examples, scene_row
from reproduction.chapter2.scenes.scene_lots import example_rows, lots, numbers_of, real_lots
from reproduction.chapter2.scenes.skeletons import perceived, reading
from reproduction.engine.estimates import share_by_cluster
from reproduction.engine.records import having, nested

LOT, REAL_LOT = 10, 4
TILTS = {"level": 0.0, "upright": 90.0}
"""Degrees between a cut's normal and up."""
TRUE = {"level": ON, "upright": ADJACENT}
TALL, BROAD = 0.05, 0.06
"""Metres: least visible height of an object that is cut, and least width across an upright cut."""
REACHES = 0.01
SEEN_TO_REACH = 0.03
"""Metres above the table below which a part's true, or visible, points must come."""
FEWEST = 150
"""Points that each part must have."""
DRAWS = 12
Row = dict[str, Any]

rows = example_rows
draw = partial(draw_examples, layers=("cloud", "relations"))


def cells(settings: Mapping) -> list[dict]:
    """Lots of simulated scenes; then of real ones, where the settings ask for them and they are there."""
    return lots(settings["scenes"], LOT) + real_lots(settings, REAL_LOT, "scenes")


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """A row for each cut, and a picture of each kind of cut from the first simulated lot."""
    if "scenes" in cell:
        rows = [
            row
            for scene in real_scenes()
            if scene.name in cell["scenes"]
            for label in free_standing(scene.truth)
            for row, _ in cuts_of(scene.cloud, label, scene.name, stream(seed, "cuts", scene.name, label))
        ]
        return {"real": True, "rows": rows, "examples": []}
    rows, examples = [], {}
    for number in numbers_of(cell, LOT, settings["scenes"]):
        for row, scene in simulated_cuts(seed, number):
            rows.append(row)
            if cell["first"] == 0 and row["kind"] not in examples:
                examples[row["kind"]] = scene_row(reading(scene), f"{row['kind']} cut: {row['said']}")
    return {"real": False, "rows": rows, "examples": [examples[kind] for kind in TILTS if kind in examples]}


def simulated_cuts(seed: int, number: int) -> list[tuple[Row, Scene]]:
    """The cuts of an object of scene `number`, drawn from those that stand by themselves and can be cut."""
    own_seed = int(stream(seed, "over-segmented").integers(2**31))
    scene = sample_scene(own_seed, number, TabletopSettings(n_objects=(2, 4), shapes="all"))
    rng = stream(seed, "cuts", number)
    for label in rng.permutation(free_standing(scene.truth)).tolist():
        outline = scene.poses[label - FIRST_OBJECT].apply(scene.shapes[label - FIRST_OBJECT].outline())
        cuts = cuts_of(scene.cloud, label, scene.name, rng, outline)
        if cuts:
            return cuts
    return []


def free_standing(truth: tuple[PairLabel, ...]) -> list[int]:
    """Objects on the table beyond doubt that no other object carries, wholly or in part."""
    carried = {t.a for t in truth if t.b != TABLE and t.relation in (ON, BOTH)}
    return sorted(
        t.a for t in truth if t.b == TABLE and t.relation == ON and t.confidence == 3 and t.a not in carried
    )


def cuts_of(
    cloud: LabelledCloud, label: int, name: str, rng: np.random.Generator, outline: NDArray | None = None
) -> list[tuple[Row, Scene]]:
    """For each kind of cut that the object allows a row and the perceived scene; none of a low object."""
    cuts = []
    if np.ptp(np.quantile(cloud.of(label)[:, 2], [0.01, 0.99])) < TALL:
        return cuts
    for kind, tilt in TILTS.items():
        found = _cut(cloud, label, tilt, rng, outline)
        if found is not None:
            scene = perceived(found[0])
            said = relation_in_words(scene.relations, found[1], label)
            cuts.append(({"scene": name, "kind": kind, "said": said}, scene))
    return cuts


def _cut(
    cloud: LabelledCloud, label: int, tilt: float, rng: np.random.Generator, outline: NDArray | None
) -> tuple[LabelledCloud, int] | None:
    """The object cut near its middle at a tilt (degrees), at any yaw; None where a part would be too small."""
    points = cloud.of(label)
    for _ in range(DRAWS):
        yaw, slope = rng.uniform(0, 2 * np.pi), np.radians(tilt)
        normal = np.array([np.sin(slope) * np.cos(yaw), np.sin(slope) * np.sin(yaw), np.cos(slope)])
        low, high = np.quantile(points @ normal, [0.01, 0.99])
        through = normal * (low + rng.uniform(0.35, 0.65) * (high - low))
        sides = (points - through) @ normal > 0
        if min(sides.sum(), (~sides).sum()) < FEWEST or (tilt > 45 and high - low < BROAD):
            continue
        # Both parts must come down to the table: the true parts where known, else their visible points.
        body, limit = (points, SEEN_TO_REACH) if outline is None else (outline, REACHES)
        beyond = (body - through) @ normal > 0
        both_reach = all(side.any() and body[side, 2].min() < limit for side in (beyond, ~beyond))
        if tilt != TILTS["upright"] or both_reach:
            return cut_object(cloud, label, normal, through)
    return None


def relation_in_words(relations: tuple[Relation, ...], part: int, label: int) -> str:
    """The relation of (part, label): *on*, *adjacent*, *both*, *none*; *on* and *both* may be turned."""
    relation = next((r for r in relations if {r.a, r.b} == {part, label}), None)
    if relation is None:
        return NONE
    turned = relation.relation in (ON, BOTH) and relation.a != part
    return f"{relation.relation}, turned" if turned else relation.relation


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Share of right relations by kind of cut, of simulated and of real scenes."""
    every = nested(results, "rows", ("real",))
    return {
        f"{true}_right_{name}": share_by_cluster(
            [row["said"] == true for row in own], [row["scene"] for row in own]
        )
        for name, real in (("simulated", False), ("real", True))
        for kind, true in TRUE.items()
        for own in [having(every, real=real, kind=kind)]
    }
