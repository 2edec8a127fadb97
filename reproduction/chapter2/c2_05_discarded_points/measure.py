"""Measures and rows of claim C2.5: exact shares of whole and perturbed scenes, losses, and networks."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, ratio_estimate
from lifelore.core.relations import CORE_RELATIONS, SYMMETRIC, PairLabel
from lifelore.perception.pairs.pair_features import PairFeatures
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.relations.relation import Relation
from lifelore.perception.relations.relation_classifier import RelationClassifier
from reproduction.chapter2.c2_05_discarded_points.run import DISCARDED, WHOLE, key_of
from reproduction.chapter2.scoring.relation_scoring import (
    JudgedPair,
    difference,
    judged_scene,
    less_rate,
    score,
    share,
)
from reproduction.engine.estimates import UNMEASURED, share_of
from reproduction.engine.results_table import computed_once

OURS, THESIS, LITERAL = "lifelore", "thesis", "literal"
METHODS = (OURS, THESIS, LITERAL)
Views = dict[str, list[JudgedPair]]
KINDS = ("simulated", "real")
UP_TO_70 = (0.3, 0.5, 0.7)
"""Shares discarded that the thesis's sentence is about."""
ROBUST = 0.03
"""Largest loss of exact share that counts as robust, as in the conditions."""
LOST = (
    *((level, THESIS, "simulated") for level in UP_TO_70),
    (0.7, THESIS, "real"),
    (0.7, LITERAL, "simulated"),
    (0.7, OURS, "simulated"),
)
"""Share discarded, method and kind of scenes of the losses that conditions ask for."""


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Losses of exact share with points discarded; the thesis's method less the majority's rate at 70 %."""
    found = judged_by_view(settings, results)
    measured = {}
    for level, method, kind in LOST:
        key = key_of(DISCARDED, level)
        measured[f"lost_{key.replace(' ', '_')}_{method}_{kind}"] = lost(found[kind][method], key)
    at_70 = found["simulated"][THESIS].get(key_of(DISCARDED, 0.7), [])
    measured["less_majority_thesis_simulated"] = less_majority(at_70)
    keys = [key_of(DISCARDED, level) for level in UP_TO_70]
    losses = [lost(found["simulated"][reading], key) for reading in (THESIS, LITERAL) for key in keys]
    robust = [loss.ci95 is not None and loss.ci95[1] <= ROBUST for loss in losses]
    return measured | {"robust_readings_and_levels": share_of(robust)}


@computed_once
def judged_by_view(settings: Mapping, results: Sequence[Mapping]) -> dict[str, dict[str, Views]]:
    """By kind of scenes, method and view the judged pairs."""
    lessons = [scene for result in results if result["kind"] == "lesson" for scene in result["scenes"]]
    models = {reading: taught(lessons, reading) for reading in (THESIS, LITERAL)}
    found: dict = {kind: {method: {} for method in METHODS} for kind in KINDS}
    for kind in KINDS:
        for scene in scenes_of(results, kind):
            for method, views in judged_views(scene, kind, models).items():
                for key, judged in views.items():
                    found[kind][method].setdefault(key, []).extend(judged)
    return found


def scenes_of(results: Sequence[Mapping], kind: str) -> list[Mapping]:
    """All scenes of a kind."""
    return [scene for result in results if result["kind"] == kind for scene in result["scenes"]]


def taught(lessons: Sequence[Mapping], reading: str) -> RelationClassifier:
    """The thesis's neighbours among the displacements of the lessons."""
    scenes = [scene_of(lesson["view"][reading]) for lesson in lessons]
    model = RelationClassifier("displacement", symmetric=SYMMETRIC)
    return model.fit_pairs(scenes, [labels_of(lesson) for lesson in lessons])


def judged_views(scene: Mapping, kind: str, models: Mapping[str, RelationClassifier]) -> dict[str, Views]:
    """By method and view, each labelled pair beside its predicted relation."""
    truth = labels_of(scene)
    gaps = {frozenset((a, b)): gap for a, b, gap in scene["gaps"]}
    found: dict[str, dict[str, list]] = {method: {} for method in METHODS}
    for key, view in scene["views"].items():
        for method, rows in view.items():
            if method in models:
                predicted = models[method].predict_pairs(scene_of(rows)) if rows else ()
            else:
                predicted = tuple(Relation(a, b, name, 1.0, gap) for a, b, name, gap in rows)
            judged = judged_scene(f"{kind} {scene['name']}", truth, predicted, gaps)
            found[method][key] = [pair for pair in judged if not (kind == "simulated" and pair.border)]
    return found


def labels_of(scene: Mapping) -> list[PairLabel]:
    """The true labels of a scene's row."""
    return [PairLabel(*row) for row in scene["truth"]]


def scene_of(rows: Sequence[Sequence]) -> ScenePairs:
    """Rows ``[a, b, gap, displacements]`` as the thesis's classifier sees a scene."""
    pairs = np.array([[[a, b], [b, a]] for a, b, *_ in rows], np.int64).reshape(-1, 2)
    gaps = np.repeat([float(gap) for _, _, gap, _ in rows], 2)
    features = PairFeatures((), np.empty((len(pairs), 0)), pairs, gaps)
    return ScenePairs(features, tuple(np.array(moved, float).reshape(-1, 3) for *_, moved in rows))


def lost(views: Mapping[str, Sequence[JudgedPair]], key: str) -> Estimate:
    """Exact share of the whole scenes less that of the perturbed ones."""
    return difference(views[WHOLE], views[key]) if views.get(WHOLE) and views.get(key) else UNMEASURED


def less_majority(judged: Sequence[JudgedPair]) -> Estimate:
    """Exact share less that of always predicting the most frequent relation with its direction known."""
    if not judged:
        return UNMEASURED
    truths = [pair.truth.relation for pair in judged]
    rate = max(truths.count(name) for name in CORE_RELATIONS) / len(truths)
    return less_rate(share(judged, lambda pair: pair.exact), rate)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """By kind of scenes, method and view the scores and the loss; then the stability of the networks."""
    views = [(WHOLE, 0.0, WHOLE)]
    views += [(way, level, key_of(way, level)) for way, levels in settings["levels"].items() for level in levels]
    found = []
    for kind, methods in judged_by_view(settings, results).items():
        for method, judged in methods.items():
            for way, level, key in views:
                scored = score(judged.get(key, []))
                if not scored:
                    continue
                recall = {name: round(number.value, 4) for name, number in scored.recall.items()}
                line = {"scenes": kind, "method": method, "way": way, "level": level, "pairs": scored.pairs}
                line |= {"exact": scored.exact.to_dict(), "on": scored.on.value, "recall": recall}
                line |= {"adjacent": scored.adjacent.value, "macro_f1": scored.macro_f1.to_dict()}
                found.append(line if way == WHOLE else line | {"lost": lost(judged, key).to_dict()})
    return found + [row for kind in KINDS for row in network_rows(settings, scenes_of(results, kind), kind)]


def network_rows(settings: Mapping, scenes: Sequence[Mapping], kind: str) -> Iterator[dict]:
    """By share discarded: networks with the node count of the whole scene; median shift of nodes, metres."""
    for level in settings["levels"].get(DISCARDED, ()) if scenes else ():
        parts = [scene["networks"][key_of(DISCARDED, level)] for scene in scenes]
        same = [part["same"] for part in parts if part["same"]]
        shifts = [shift for part in parts for shift in part["shifts"]]
        stable = ratio_estimate([sum(s) for s in same], [len(s) for s in same]) if same else UNMEASURED
        same_nodes = Estimate(stable.value, stable.median, stable.ci95, sum(map(len, same))).to_dict()
        shift = float(np.median(shifts)) if shifts else None
        yield {"scenes": kind, "discarded": level, "same_nodes": same_nodes, "median_shift": shift}
