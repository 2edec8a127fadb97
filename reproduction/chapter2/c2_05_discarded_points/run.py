"""Cells of claim C2.5: scenes whose clouds get worse step by step, with relations, displacements and networks.

A cell perceives some held-out scenes, whole and perturbed in every way of the settings. It stores the relations of
the shipped model with scene logic, and the displacements χ_a - χ_b of two readings of the thesis's method, which
neighbours from other scenes (cells of lessons) classify later: *thesis* with contacts of clouds thinned to one
spacing, the strongest never dropped; *literal* with contacts of the clouds as they come, at a fixed cost, each
below 7 support vectors dropped. The table's points are left out, as the thesis's background was (§2.3.2).
Thesis: §2.4.1.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene
from lifelore.perception.contacts.contact_points import contact_clusters
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS, Interface, interfaces
from lifelore.perception.contacts.near_pairs import near_pairs, split_objects
from lifelore.perception.pairs.scene_pairs import scene_pairs
from lifelore.perception.reasoning.scene_logic import alternatives, most_likely_scene
from lifelore.perception.relations.relation_classifier import shipped_model
from lifelore.perception.separation.separator import separate
from reproduction.chapter2.scenes.perturbation import (
    fewer_points,
    grown_masks,
    noisier_depth,
    swapped_border,
)
from reproduction.chapter2.scenes.real_scenes import real_scenes
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of, real_lots
from reproduction.chapter2.scenes.skeletons import shipped_model_digest
from reproduction.chapter2.scenes.tabletop_pairs import without_table
from reproduction.chapter2.scoring.network_stability import contact_nodes, stability
from reproduction.chapter2.scoring.pair_validation import THRESHOLD

DISCARDED, NOISE, BORDER, MASKS = "discarded", "noise", "border", "masks"
WAYS = {
    DISCARDED: fewer_points,
    NOISE: noisier_depth,
    BORDER: lambda cloud, level, rng: swapped_border(cloud, rng, probability=level),
    MASKS: lambda cloud, level, rng: grown_masks(cloud, rng, width=level),
}
"""Way by name: takes a cloud, how much, and a generator. Shares for *discarded* and *border*, else metres."""
WHOLE = "whole"
LESSON_LOT, LOT, REAL_LOT = 10, 4, 2


def key_of(way: str, level: float) -> str:
    """The name of a perturbed view: ``discarded 0.7``."""
    return f"{way} {level:g}"


def cells(settings: Mapping) -> list[dict]:
    """Lots of lessons, of held-out scenes, and of real scenes where the settings ask for them and they are there.

    Cells name the shipped model, so that cells of another model are run anew.
    """
    model = shipped_model_digest()
    lessons = [{"lessons": k} for k in range(0, settings["lessons"], LESSON_LOT)]
    held_out = lots(settings["scenes"], LOT, model=model)
    return lessons + held_out + real_lots(settings, REAL_LOT, "real", model=model)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """``{"kind": "lesson" | "simulated" | "real", "scenes": […]}``."""
    if "lessons" in cell:
        numbers = range(cell["lessons"], min(cell["lessons"] + LESSON_LOT, settings["lessons"]))
        return {"kind": "lesson", "scenes": [_lesson(settings, seed, number) for number in numbers]}
    if "real" in cell:
        scenes = [scene for scene in real_scenes() if scene.name in cell["real"]]
        return {"kind": "real", "scenes": [_seen(settings, s.name, s.cloud, s.truth, {}) for s in scenes]}
    found = []
    for number in numbers_of(cell, LOT, settings["scenes"]):
        scene = _drawn(settings, seed, "held-out", number)
        gaps = {(gap.a, gap.b): gap.visible for gap in scene.gaps}
        found.append(_seen(settings, scene.name, scene.cloud, scene.truth, gaps))
    return {"kind": "simulated", "scenes": found}


def _drawn(settings: Mapping, seed: int, shapes: str, number: int):
    own = int(stream(seed, "spoilt scenes", shapes).integers(2**31))
    return sample_scene(own, number, TabletopSettings(shapes=shapes, camera=settings["camera"]))


def _lesson(settings: Mapping, seed: int, number: int) -> dict:
    scene = _drawn(settings, seed, "training", number)
    bare = without_table(scene.cloud)
    return {
        "name": scene.name,
        "truth": _truth_rows(scene.truth),
        "view": {"thesis": _contact_rows(interfaces(bare)), "literal": literal_rows(bare)},
    }


def _seen(settings: Mapping, name: str, cloud: LabelledCloud, truth: Sequence[PairLabel], gaps: Mapping) -> dict:
    """A scene whole and perturbed; gaps of all views are those of the whole scene."""
    whole, found = _view(cloud, literal=True)
    nodes = contact_nodes(found, truth)
    views, networks = {WHOLE: whole}, {}
    for way, levels in settings["levels"].items():
        for level in levels:
            key = key_of(way, level)
            worse = WAYS[way](cloud, level, stream(0, "spoilt", name, key))
            views[key], found = _view(worse, literal=way == DISCARDED)
            if way == DISCARDED:
                fared = stability(nodes, contact_nodes(found, truth))
                shifts = [round(shift, 6) for shift in fared.shifts]
                networks[key] = {"same": [int(same) for same in fared.same_count], "shifts": shifts}
    rows = [[a, b, round(gap, 6)] for (a, b), gap in gaps.items()]
    return {"name": name, "truth": _truth_rows(truth), "gaps": rows, "views": views, "networks": networks}


def _truth_rows(truth: Sequence[PairLabel]) -> list[list]:
    """Labels of pairs of objects without the table."""
    return [[t.a, t.b, t.relation, t.confidence] for t in truth if TABLE not in (t.a, t.b)]


def _view(cloud: LabelledCloud, literal: bool) -> tuple[dict[str, Any], tuple[Interface, ...]]:
    """The relations and displacements of a cloud, and its interfaces."""
    bare = without_table(cloud)
    found = interfaces(bare)
    beliefs = shipped_model().beliefs_of(scene_pairs(bare, found))
    relations = most_likely_scene(alternatives(beliefs), cloud.objects).relations
    view: dict[str, Any] = {
        "lifelore": [[r.a, r.b, r.relation, round(r.gap, 6)] for r in relations if TABLE not in (r.a, r.b)],
        "thesis": _contact_rows(found),
    }
    if literal:
        view["literal"] = literal_rows(bare)
    return view, found


def _contact_rows(found: Sequence[Interface]) -> list[list]:
    """``[a, b, gap, displacements]`` of each pair."""
    rows = []
    for pair in found:
        first, second = ([contact.position for contact in side] for side in (pair.contacts_a, pair.contacts_b))
        rows.append(_row(pair.a, pair.b, pair.gap, np.array(first), np.array(second)))
    return rows


def _row(a: int, b: int, gap: float, first: NDArray[np.float64], second: NDArray[np.float64]) -> list:
    moved = (first[:, None] - second[None]).reshape(-1, 3)
    return [a, b, round(gap, 6), np.round(moved, 6).tolist()]


def literal_rows(bare: LabelledCloud, settings: ContactSettings = DEFAULT_CONTACT_SETTINGS) -> list[list]:
    """By the thesis's literal text: all points, a cost for each point, contacts below 7 support vectors dropped.

    Pairs without a contact on either side have no row.
    """
    rows = []
    for pair in near_pairs(split_objects(bare), settings.near, settings.table_margin):
        a, b = pair.first.points, pair.second.points
        found = separate(a, b, length=settings.length, cost=settings.cost)
        first = strong_places(a[found.support_first], found.alpha_first, settings.linkage)
        second = strong_places(b[found.support_second], found.alpha_second, settings.linkage)
        if len(first) and len(second):
            rows.append(_row(pair.first.label, pair.second.label, pair.gap, first, second))
    return rows


def strong_places(
    points: NDArray[np.float64], alpha: NDArray[np.float64], linkage: float, least: int = THRESHOLD
) -> NDArray[np.float64]:
    """Contact points of at least `least` support vectors, ``(m, 3)``, none where there are none."""
    clusters = [rows for rows in contact_clusters(points, alpha, linkage, least) if len(rows) >= least]
    places = [alpha[rows] @ points[rows] / alpha[rows].sum() for rows in clusters]
    return np.array(places).reshape(-1, 3)


def check(settings: Mapping) -> None:
    if set(settings["levels"]) - set(WAYS) or not settings["levels"]:
        raise InputError(f"levels must name some of {', '.join(WAYS)}, got {', '.join(settings['levels'])}")
