"""C2.6: holes found in scenes that have a hole (thesis Fig. 2.6) and in controls without a hole.

With a hole: an L-block that carries one of two *hinged* blocks, or an *other* object (an arch, a toy on legs, a
plank). Without: a *long* contact; the same *split* in two where points are missing in the middle; a block in the
L-block's *corner*, which touches it below and beside. Contacts with the ground take no part. Thesis: §2.4.2.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.metrics import Estimate
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopScene
from lifelore.perception.contacts.interface import interfaces
from lifelore.perception.scene import Scene
from lifelore.perception.topology.holes import Hole, find_holes
from reproduction.chapter2.c2_06_same_hole.passage import passages
from reproduction.chapter2.scenes.arranged_scenes import arranged
from reproduction.chapter2.scenes.perturbation import part_of
from reproduction.chapter2.scenes.scene_example import draw_examples, scene_row
from reproduction.chapter2.scenes.scene_lots import example_rows, lots, numbers_of
from reproduction.engine.estimates import exact_share
from reproduction.engine.records import having, nested

ARRANGEMENTS = {
    "hinged": "hole-hinged",
    "other": "hole-other",
    "long": "no-hole",
    "split": "no-hole",
    "corner": "corner",
}
LOT = 15
LOWER, UPPER = 2, 3
_BAND = (0.03, 0.06)
"""Metres of a long contact from which points are missing: more than what links support vectors."""
_CLOSE = 0.025
WITH_HOLE = CAPTIONS = {"hinged": "hinged blocks", "other": "another object"}
"""Kinds that have a hole, and captions of their pictures."""

rows, draw = example_rows, draw_examples


def cells(settings: Mapping) -> list[dict]:
    """Scenes in lots, by kind."""
    return [lot for kind in ARRANGEMENTS for lot in lots(settings["scenes"], LOT, kind=kind)]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Findings of a lot of scenes of a kind, and a picture of a scene with a hole from the first lot."""
    kind, rows, examples = cell["kind"], [], []
    for number in numbers_of(cell, LOT, settings["scenes"]):
        world = arranged(ARRANGEMENTS[kind], seed, number)
        cloud = split_contact(world.cloud, stream(seed, "split", number)) if kind == "split" else world.cloud
        scene = objects_only(cloud)
        rows.append(findings(scene, world))
        if number == 0 and kind in CAPTIONS:
            examples = [scene_row(scene, CAPTIONS[kind])]
    return {"kind": kind, "scenes": rows, "examples": examples}


def objects_only(cloud: LabelledCloud) -> Scene:
    """The scene of the objects alone, without contacts with the table."""
    return Scene(cloud, tuple(pair for pair in interfaces(cloud) if TABLE not in (pair.a, pair.b)))


def findings(scene: Scene, world: TabletopScene) -> dict:
    """Whether a hole is found; of the smallest hole its form, and whether it lies at a true passage.

    `form` is the number of contact points on the lower and the upper object, `true` whether a way for a straight
    stick along the L-block's foot passes through the true scene where a hole was found.
    """
    holes = find_holes(scene)
    if not holes:
        return {"hole": False}
    ways = passages(world.shapes, world.poses, world.poses[0].rotation[:, 1])
    form = [sum(label == own for label, _ in holes[0].nodes) for own in (LOWER, UPPER)]
    return {
        "hole": True,
        "form": form,
        "true": any(lies_between(way, hole, scene) for way in ways for hole in holes),
    }


def lies_between(way: NDArray[np.float64], hole: Hole, scene: Scene) -> bool:
    """Whether most of a passage ``(k, 3)`` lies between the two places where a hole's loop changes objects."""
    at = np.array([scene.position(*node) for node in hole.nodes])
    label = np.array([node[0] for node in hole.nodes])
    changes = np.flatnonzero(label != np.roll(label, -1))
    first, last = ((at[k] + at[(k + 1) % len(at)]) / 2 for k in (changes[0], changes[-1]))
    share = (way - first) @ (last - first) / ((last - first) @ (last - first))
    return bool(((share > 0) & (share < 1)).mean() > 0.5)


def split_contact(cloud: LabelledCloud, rng: np.random.Generator) -> LabelledCloud:
    """The cloud of a long contact less a band across it.

    Half of the time all that lies in the band is missing, as behind a bar in front of the scene; else only what
    lies close to the other object, as where a shadow falls on the contact.
    """
    contact = next(pair for pair in interfaces(cloud) if (pair.a, pair.b) == (LOWER, UPPER))
    assert contact.pair is not None
    lower, upper = contact.pair.first.points, contact.pair.second.points
    near = upper[np.isfinite(KDTree(lower).query(upper, distance_upper_bound=_CLOSE)[0])]
    middle = near.mean(axis=0)
    along = np.append(np.linalg.svd(near[:, :2] - middle[:2], full_matrices=False)[2][0], 0.0)
    width = rng.uniform(*_BAND)
    at = (near - middle) @ along
    centre = rng.uniform(*np.quantile(at, [0.4, 0.6]))
    gone = np.abs((cloud.points - middle) @ along - centre) < width / 2
    if rng.random() < 0.5:
        gone &= np.abs(cloud.points[:, 2] - middle[2]) < _CLOSE
    return part_of(cloud, ~(gone & (cloud.labels > TABLE)))


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of scenes by kind with a hole found; form and place of the holes."""
    scenes = nested(results, "scenes", ("kind",))
    found = {
        f"hole_found_{kind}": exact_share(scene["hole"] for scene in having(scenes, kind=kind))
        for kind in ARRANGEMENTS
    }
    holes = [scene for scene in scenes if scene["hole"] and scene["kind"] in WITH_HOLE]
    found["found_where_the_passage_is"] = exact_share(scene["true"] for scene in holes)
    found["two_contacts_on_either_side"] = exact_share(scene["form"] == [2, 2] for scene in holes)
    return found
