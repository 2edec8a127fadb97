"""Cells of claim C2.6: holes found in scenes that have a hole (thesis Fig. 2.6) and in controls without a hole.

With a hole: an L-block that carries one of two *hinged* blocks, or an *other* object (an arch, a toy on legs, a
plank). Without: a *long* contact; the same *split* in two where points are missing in the middle; a block in the
L-block's *corner*, which touches it below and beside. Contacts with the ground take no part. Thesis: §2.4.2.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopScene
from lifelore.perception.contacts.interface import interfaces
from lifelore.perception.scene import Scene
from lifelore.perception.topology.holes import Hole, contact_loops, find_holes
from reproduction.chapter2.c2_06_same_hole.passage import passages
from reproduction.chapter2.scenes.arranged_scenes import arranged
from reproduction.chapter2.scenes.perturbation import part_of
from reproduction.chapter2.scenes.real_scenes import real_scenes
from reproduction.chapter2.scenes.scene_example import scene_row
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of, uses_real

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
CAPTIONS = {
    "hinged": "hinged blocks",
    "animal": "a toy on legs",
    "arch": "an arch",
    "box": "a plank",
    "long": "a long contact",
    "split": "the same, split",
    "corner": "a block in the corner",
}
PICTURES = {"other": 2}
"""Number of pictures of a kind, where more than one."""


def cells(settings: Mapping) -> list[dict]:
    """Scenes in lots, by kind; then the real scenes, where the settings ask for them and they are there."""
    real = real_scenes() if uses_real(settings) else ()
    simulated = [lot for kind in ARRANGEMENTS for lot in lots(settings["scenes"], LOT, kind=kind)]
    return simulated + [{"kind": "real", "scene": scene.name} for scene in real]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Findings of a lot of scenes of a kind, or of a real scene, and a picture from the first lot."""
    kind = cell["kind"]
    if kind == "real":
        scene = next(scene for scene in real_scenes() if scene.name == cell["scene"])
        found = find_holes(objects_only(scene.cloud))
        return {"kind": kind, "scenes": [{"scene": scene.name, "holes": len(found)}], "examples": []}
    rows, pictures = [], {}
    for number in numbers_of(cell, LOT, settings["scenes"]):
        world = arranged(ARRANGEMENTS[kind], seed, number)
        cloud = split_contact(world.cloud, stream(seed, "split", number)) if kind == "split" else world.cloud
        scene = objects_only(cloud)
        rows.append({"scene": number, **findings(scene, world)})
        shape = world.shapes[-1].kind
        if cell["first"] == 0 and shape not in pictures and len(pictures) < PICTURES.get(kind, 1):
            pictures[shape] = scene_row(scene, f"{CAPTIONS.get(kind) or CAPTIONS[shape]}: {_outcome(rows[-1])}")
    return {"kind": kind, "scenes": rows, "examples": list(pictures.values())}


def _outcome(row: Mapping) -> str:
    if row["holes"]:
        return f"a hole, {row['opening']:.0f} mm wide"
    return "a cycle, no hole" if row["loops"] else "no cycle"


def objects_only(cloud: LabelledCloud) -> Scene:
    """The scene of the objects alone, without contacts with the table."""
    return Scene(cloud, tuple(pair for pair in interfaces(cloud) if TABLE not in (pair.a, pair.b)))


def findings(scene: Scene, world: TabletopScene) -> dict:
    """Numbers of loops and holes; of the smallest hole its form, size and opening in mm; the true passages.

    `form` is the number of contact points on the lower and the upper object, `passages` the number of ways through
    the true scene along the L-block's foot, `real` whether a passage lies where a hole was found.
    """
    holes = find_holes(scene)
    ways = passages(world.shapes, world.poses, world.poses[0].rotation[:, 1])
    row = {"thing": world.shapes[-1].kind, "loops": len(contact_loops(scene)), "holes": len(holes)}
    row["passages"] = len(ways)
    if not holes:
        return row
    return row | {
        "form": [sum(label == own for label, _ in holes[0].nodes) for own in (LOWER, UPPER)],
        "size": round(1000 * holes[0].size, 1),
        "opening": round(1000 * holes[0].opening, 1),
        "real": any(lies_between(way, hole, scene) for way in ways for hole in holes),
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
