"""C2.11: support vectors and contact points of two objects that are moved apart, without any limit of distance.

A pair is photographed together and thinned to 3 mm. Then the points of one object are moved away from those of the
other, so that shape, density and noise stay and only the gap grows: straight up where it rests on the other, along
the table where it stands beside it. A contact has at least 7 support vectors (§2.3.4). Thesis: §2.4.1.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.relations import NONE, ON, PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopSettings, sample_scene
from lifelore.perception.clouds.voxel import voxelised
from lifelore.perception.contacts.contact_points import linked
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS
from lifelore.perception.separation.separator import separate
from reproduction.chapter2.scenes.perturbation import without_table
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of
from reproduction.chapter2.scenes.tabletop_pairs import LEAST_CONFIDENCE, MIX, kernel_name
from reproduction.chapter2.scoring.pair_validation import THRESHOLD
from reproduction.engine.estimates import exact_share

DEFAULT = DEFAULT_CONTACT_SETTINGS.length, DEFAULT_CONTACT_SETTINGS.cost
LOT = 4
_EXACT = 1e-4
"""Metres to which a gap is met."""
Points = NDArray[np.float64]


def cells(settings: Mapping) -> list[dict]:
    """Lots of simulated pairs."""
    return lots(settings["pairs"], LOT)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """``{"pairs": […]}``, each pair as `parted`."""
    drawn = TabletopSettings(arrangement="pair", mix=MIX, shapes="all", camera=settings["camera"])
    own, numbers = int(stream(seed, "parted pairs").integers(2**31)), numbers_of(cell, LOT, settings["pairs"])
    scenes = (sample_scene(own, k, drawn) for k in numbers)
    return {"pairs": [parted(settings, *pair) for s in scenes for pair in bearing_pairs(s.cloud, s.truth)]}


def bearing_pairs(cloud: LabelledCloud, truth: Sequence[PairLabel]) -> Iterator[tuple[Points, Points, str]]:
    """Points of a and b, and the relation, of each pair of objects with a relation."""
    thin = voxelised(without_table(cloud), DEFAULT_CONTACT_SETTINGS.voxel)
    for label in truth:
        if TABLE not in (label.a, label.b) and label.relation != NONE and label.confidence >= LEAST_CONFIDENCE:
            yield thin.of(label.a), thin.of(label.b), label.relation


def parted(settings: Mapping, a: Points, b: Points, relation: str) -> dict:
    """Support vectors and contacts of both objects, by kernel a list over the gaps: as seen, then in order.

    ``gap``, metres, as seen; ``support``, mean of the two objects; ``contacts``, of both together.
    """
    tree, way = KDTree(b), away(a, b, relation)
    moved = [a, *(a + shift_to(a, tree, way, gap) * way for gap in gaps(settings))]
    found = {kernel_name(*own): [counts(points, b, *own) for points in moved] for own in kernels(settings)}
    return {"gap": round(float(tree.query(a)[0].min()), 5), "found": found}


def gaps(settings: Mapping) -> list[float]:
    """The gaps in increasing order, metres; the last is *far apart*."""
    return sorted(settings["gaps"])


def kernels(settings: Mapping) -> list[tuple[float, float]]:
    """(length in metres, cost per point) of each kernel, the default among them."""
    return list(dict.fromkeys([DEFAULT, *product(settings["lengths"], settings["costs"])]))


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


def counts(a: Points, b: Points, length: float, cost: float) -> list[float]:
    """Support vectors, mean of the two objects, and contacts of at least `THRESHOLD` of both together."""
    found = separate(a, b, length=length, cost=cost)
    sides = [a[found.support_first], b[found.support_second]]
    sizes = [np.bincount(linked(np.ascontiguousarray(side), DEFAULT_CONTACT_SETTINGS.linkage)) for side in sides]
    return [sum(map(len, sides)) / 2, int(sum((own >= THRESHOLD).sum() for own in sizes))]


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The measures under every kernel."""
    for length, cost in kernels(settings):
        yield {"length": length, "cost": cost}, measures(results, kernel_name(length, cost))


def measures(results: Sequence[Mapping], kernel: str) -> dict[str, Estimate]:
    """Far apart: shares of pairs without a contact and with few support vectors; their ratio to those as seen."""
    found = np.array([pair["found"][kernel] for result in results for pair in result["pairs"]])
    seen, far = found[:, 0, 0], found[:, -1, 0]
    return {
        "no_contacts_far": exact_share(found[:, -1, 1] == 0),
        "few_far": exact_share(far < THRESHOLD),
        "far_over_seen": mean_estimate(far / seen),
    }
