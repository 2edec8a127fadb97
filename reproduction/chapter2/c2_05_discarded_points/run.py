"""C2.5: relations of the thesis's method when points of the clouds are discarded at random (§2.4.1).

Contacts are found in two ways. *Thinned*: clouds are thinned to one spacing, which scales the separator's cost and
the threshold of 7 support vectors with resolution; an object's strongest contact stays. *Raw*: all points as they
come, at a fixed cost, with the threshold scaled by the share of points that is left, or fixed at 7. Displacements
between contacts are classified by neighbours that learnt from whole clouds of other scenes.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.intervals import percentile_interval
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.metrics import Estimate
from lifelore.core.relations import CORE_RELATIONS, SYMMETRIC, PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, sample_scene
from lifelore.perception.contacts.contact_points import contact_clusters
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS, interfaces
from lifelore.perception.contacts.near_pairs import near_pairs, split_objects
from lifelore.perception.pairs.pair_features import PairFeatures
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.relations.relation_classifier import RelationClassifier
from lifelore.perception.separation.separator import separate
from reproduction.chapter2.scenes.perturbation import fewer_points, without_table
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of
from reproduction.chapter2.scoring.pair_validation import THRESHOLD
from reproduction.chapter2.scoring.relation_scoring import JudgedPair, judged_scene, less_rate
from reproduction.engine.estimates import UNMEASURED, share_by_cluster

THINNED, SCALED, FIXED = METHODS = ("thinned, threshold scaled", "raw, threshold scaled", "raw, 7 fixed")
LOT = 6
Pairs = list[list]
"""``[a, b, gap, displacements]`` of each near pair with displacements."""


def cells(settings: Mapping) -> list[dict]:
    """Lots of lessons, then of held-out scenes."""
    return lots(settings["lessons"], LOT, kind="lessons") + lots(settings["scenes"], LOT, kind="scenes")


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """``{"kind", "scenes": […]}``: truth, gaps, and displacements by share discarded and method of each scene."""
    kind, shapes = cell["kind"], {"lessons": "training", "scenes": "held-out"}[cell["kind"]]
    own = int(stream(seed, "spoilt scenes", shapes).integers(2**31))
    levels = levels_of(settings) if kind == "scenes" else [0.0]
    found = []
    for number in numbers_of(cell, LOT, settings[kind]):
        scene = sample_scene(own, number, TabletopSettings(shapes=shapes, camera=settings["camera"]))
        found.append(seen(scene, levels))
    return {"kind": kind, "scenes": found}


def levels_of(settings: Mapping) -> list[float]:
    """The shares discarded, none first."""
    return [0.0, *(level for level in settings["discarded"] if level > 0)]


def seen(scene: TabletopScene, levels: Sequence[float]) -> dict:
    """A scene at each share discarded; gaps are those of the whole scene."""
    views = []
    for level in levels:
        cloud = fewer_points(scene.cloud, level, stream(0, "spoilt", scene.name, f"discarded {level:g}"))
        views.append(view(without_table(cloud), 1 - level))
    truth = [[t.a, t.b, t.relation, t.confidence] for t in scene.truth if TABLE not in (t.a, t.b)]
    gaps = [[gap.a, gap.b, round(gap.visible, 6)] for gap in scene.gaps]
    return {"name": scene.name, "truth": truth, "gaps": gaps, "views": views}


def view(bare: LabelledCloud, left: float) -> dict[str, Pairs]:
    """The displacements of a cloud by method; `left` is the share of points that is left, in (0, 1]."""
    thinned = []
    for pair in interfaces(bare):
        places = ([contact.position for contact in side] for side in (pair.contacts_a, pair.contacts_b))
        thinned.append(row(pair.a, pair.b, pair.gap, *places))
    return {THINNED: thinned, **raw_rows(bare, {SCALED: THRESHOLD * left, FIXED: THRESHOLD})}


def raw_rows(bare: LabelledCloud, thresholds: Mapping[str, float]) -> dict[str, Pairs]:
    """Displacements from all points at a fixed cost a point, by threshold; pairs without a contact have no row."""
    settings, found = DEFAULT_CONTACT_SETTINGS, {name: [] for name in thresholds}
    for pair in near_pairs(split_objects(bare), settings.near, settings.table_margin):
        a, b = pair.first.points, pair.second.points
        parted = separate(a, b, length=settings.length, cost=settings.cost)
        for name, least in thresholds.items():
            first = strong_places(a[parted.support_first], parted.alpha_first, settings.linkage, least)
            second = strong_places(b[parted.support_second], parted.alpha_second, settings.linkage, least)
            if len(first) and len(second):
                found[name].append(row(pair.first.label, pair.second.label, pair.gap, first, second))
    return found


def strong_places(
    points: NDArray[np.float64], alpha: NDArray[np.float64], linkage: float, least: float = THRESHOLD
) -> NDArray[np.float64]:
    """Contact points of at least `least` support vectors, ``(m, 3)``, none where there are none."""
    clusters = contact_clusters(points, alpha, linkage, least)
    return np.array([alpha[rows] @ points[rows] / alpha[rows].sum() for rows in clusters]).reshape(-1, 3)


def row(a: int, b: int, gap: float, first: Sequence | NDArray, second: Sequence | NDArray) -> list:
    """``[a, b, gap, displacements]`` of a pair."""
    moved = np.asarray(first)[:, None] - np.asarray(second)[None]
    return [a, b, round(gap, 6), np.round(moved.reshape(-1, 3), 5).tolist()]


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, dict[str, Estimate]]]:
    """The measures of each method."""
    for method, views in judged(settings, results).items():
        yield {"contacts": method}, measures(views)


def measures(views: Mapping[float, Sequence[JudgedPair]]) -> dict[str, Estimate]:
    """Exact share lost at each share discarded; and that of the most discarded less the majority's rate."""
    falls = {f"lost_{100 * level:g}": lost(views[0.0], views[level]) for level in views if level}
    worst = views[max(views)]
    truths = [pair.truth.relation for pair in worst]
    rate = max(map(truths.count, CORE_RELATIONS)) / max(len(truths), 1)
    return falls | {"less_majority": less_rate(share(worst), rate) if worst else UNMEASURED}


def lost(whole: Sequence[JudgedPair], left: Sequence[JudgedPair]) -> Estimate:
    """Exact share of the whole clouds' pairs less that of the same pairs in what is left; scenes resampled."""
    names, at = np.unique([pair.scene for pair in whole], return_inverse=True)
    falls, n = [float(a.exact) - b.exact for a, b in zip(whole, left, strict=True)], len(names)
    sums = np.stack([np.bincount(at, falls), np.bincount(at)], axis=1)
    drawn = stream(n, "scenes resampled").multinomial(n, np.full(n, 1 / n), size=1000) @ sums
    value = float(np.mean(falls))
    return Estimate(value, value, percentile_interval(drawn[:, 0] / drawn[:, 1]), len(whole))


def share(pairs: Sequence[JudgedPair]) -> Estimate:
    """Share classified exactly; scenes are resampled, whose pairs share a camera, its noise and neighbours."""
    return share_by_cluster([pair.exact for pair in pairs], [pair.scene for pair in pairs])


def judged(settings: Mapping, results: Sequence[Mapping]) -> dict[str, dict[float, list[JudgedPair]]]:
    """By method and share discarded, each labelled pair of the held-out scenes beside its predicted relation.

    Pairs whose gap is so near the limit of *adjacent* that the gap alone decides are left out.
    """
    lessons, scenes = (
        [scene for result in results if result["kind"] == kind for scene in result["scenes"]]
        for kind in ("lessons", "scenes")
    )
    found: dict[str, dict[float, list[JudgedPair]]] = {method: {} for method in METHODS}
    for method, of_level in found.items():
        model = RelationClassifier("displacement", symmetric=SYMMETRIC)
        model.fit([scene_of(own["views"][0][method]) for own in lessons], list(map(labels_of, lessons)))
        for scene in scenes:
            gaps = {frozenset((a, b)): gap for a, b, gap in scene["gaps"]}
            for level, views in zip(levels_of(settings), scene["views"], strict=True):
                predicted = model.predict(scene_of(views[method])) if views[method] else ()
                own = judged_scene(scene["name"], labels_of(scene), predicted, gaps)
                of_level.setdefault(level, []).extend(pair for pair in own if not pair.border)
    return found


def labels_of(scene: Mapping) -> list[PairLabel]:
    """The true labels of a scene's row."""
    return [PairLabel(*row) for row in scene["truth"]]


def scene_of(pairs: Pairs) -> ScenePairs:
    """Rows ``[a, b, gap, displacements]`` as the thesis's classifier sees a scene."""
    both = np.array([[[a, b], [b, a]] for a, b, *_ in pairs], np.int64).reshape(-1, 2)
    gaps = np.repeat([float(gap) for _, _, gap, _ in pairs], 2)
    features = PairFeatures((), np.empty((len(both), 0)), both, gaps)
    return ScenePairs(features, tuple(np.array(moved, float).reshape(-1, 3) for *_, moved in pairs))
