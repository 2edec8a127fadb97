"""Cells of claim C2.11: the separator between two objects that are moved apart gap by gap, at any distance.

A pair is photographed together and thinned to 3 mm. Then the points of one object are moved away from those of the
other, so that shape, density and noise stay and only the gap grows: straight up where it rests on the other, along
the table where it stands beside it. Support vectors are clustered as in perception, with and without the thesis's
rule that a contact has at least 7 of them. Thesis: §2.3.4, §2.4.1.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import NONE, ON, PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene
from lifelore.perception.clouds.voxel import voxelised
from lifelore.perception.contacts.contact_points import linked
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS
from lifelore.perception.separation.separator import separate
from reproduction.chapter2.scenes.real_scenes import real_scenes
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of, real_lots
from reproduction.chapter2.scenes.tabletop_pairs import LEAST_CONFIDENCE, MIX, without_table
from reproduction.chapter2.scoring.pair_validation import THRESHOLD

LOT, REAL_LOT = 4, 4
_EXACT = 1e-4
"""Metres to which a gap is met."""
Points = NDArray[np.float64]


def cells(settings: Mapping) -> list[dict]:
    """Lots of simulated pairs, then of real scenes where the settings ask for them and they are there."""
    return lots(settings["pairs"], LOT) + real_lots(settings, REAL_LOT, "real")


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """``{"kind": "simulated" | "real", "pairs": […]}``, each pair as `parted`."""
    if "real" in cell:
        scenes = [(scene.cloud, scene.truth) for scene in real_scenes() if scene.name in cell["real"]]
    else:
        drawn = TabletopSettings(arrangement="pair", mix=MIX, shapes="all", camera=settings["camera"])
        own, numbers = int(stream(seed, "parted pairs").integers(2**31)), numbers_of(cell, LOT, settings["pairs"])
        scenes = [(s.cloud, s.truth) for s in (sample_scene(own, k, drawn) for k in numbers)]
    found = [parted(settings, *pair) for cloud, truth in scenes for pair in bearing_pairs(cloud, truth)]
    return {"kind": "real" if "real" in cell else "simulated", "pairs": found}


def bearing_pairs(cloud: LabelledCloud, truth: Sequence[PairLabel]) -> Iterator[tuple[Points, Points, str]]:
    """Points of a and b, and the relation, of each pair of objects with a relation."""
    thin = voxelised(without_table(cloud), DEFAULT_CONTACT_SETTINGS.voxel).cloud
    for label in truth:
        if TABLE not in (label.a, label.b) and label.relation != NONE and label.confidence >= LEAST_CONFIDENCE:
            yield thin.of(label.a), thin.of(label.b), label.relation


def parted(settings: Mapping, a: Points, b: Points, relation: str) -> dict:
    """Support vectors and contacts at every gap and kernel.

    ``relation``; ``size``, the diagonal of the larger object's box, metres; ``gaps``, metres, first as seen, then
    those of ``settings["gaps"]``, then ``settings["sizes"]`` times the size; ``found``, ``[gap, kernel, support
    vectors of a, of b, contacts of a, of b, contacts of 7 of a, of b, violation]`` with gap and kernel by number.
    """
    size = max(float(np.linalg.norm(np.ptp(points, axis=0))) for points in (a, b))
    tree = KDTree(b)
    wanted = [*settings["gaps"], *(times * size for times in settings["sizes"])]
    way = away(a, b, relation)
    moved = [a, *(a + shift_to(a, tree, way, gap) * way for gap in wanted)]
    found = [
        [number, kernel, *counts(points, b, length, cost)]
        for number, points in enumerate(moved)
        for kernel, (length, cost) in enumerate(kernels(settings))
    ]
    gaps = [round(_gap(points, tree), 5) for points in moved]
    return {"relation": relation, "size": round(size, 4), "gaps": gaps, "found": found}


def kernels(settings: Mapping) -> list[tuple[float, float]]:
    """(length in metres, cost per point) of each kernel."""
    return [(float(length), float(cost)) for length, cost in product(settings["lengths"], settings["costs"])]


def away(a: Points, b: Points, relation: str) -> Points:
    """The unit vector along which a leaves b: up from its support, else along the table."""
    if relation == ON:
        return np.array([0.0, 0.0, 1.0])
    apart = np.append((a.mean(axis=0) - b.mean(axis=0))[:2], 0.0)
    length = float(np.linalg.norm(apart))
    return apart / length if length > 1e-6 else np.array([1.0, 0.0, 0.0])


def shift_to(a: Points, tree: KDTree, way: Points, gap: float) -> float:
    """How far a must move for `gap` metres between the two, by bisection to `_EXACT`."""
    low, high = 0.0, 0.05
    while _is_nearer(a + high * way, tree, gap):
        low, high = high, 2 * high
    while high - low > _EXACT:
        middle = (low + high) / 2
        low, high = (middle, high) if _is_nearer(a + middle * way, tree, gap) else (low, middle)
    return high


def _is_nearer(points: Points, tree: KDTree, gap: float) -> bool:
    """Whether some point is nearer than `gap`; a bounded search is several times cheaper than the distance."""
    box = np.clip(points, tree.mins, tree.maxes)
    close = points[
        ((points - box) ** 2).sum(axis=1) < gap * gap
    ]  # no point is nearer than its distance to the box
    return bool(len(close)) and bool(np.isfinite(tree.query(close, distance_upper_bound=gap)[0]).any())


def _gap(points: Points, tree: KDTree) -> float:
    return float(tree.query(points)[0].min())


def counts(a: Points, b: Points, length: float, cost: float) -> list:
    """Support vectors, contacts and contacts of at least 7, each of a and of b; and the separator's violation."""
    found = separate(a, b, length=length, cost=cost)
    sides = [a[found.support_first], b[found.support_second]]
    sizes = [np.bincount(linked(np.ascontiguousarray(side), DEFAULT_CONTACT_SETTINGS.linkage)) for side in sides]
    strong = [int((own >= THRESHOLD).sum()) for own in sizes]
    return [*map(len, sides), *map(len, sizes), *strong, round(found.max_violation, 5)]


FAR = 1.0
"""Metres: the gap that the conditions ask about; some five to ten sizes."""


def check(settings: Mapping) -> None:
    if FAR not in settings["gaps"]:
        raise InputError(f"gaps must hold {FAR:g} m, which the conditions ask about, got {settings['gaps']}")
