"""Measures and rows of claim C2.5."""

import json
from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.core.relations import CORE_RELATIONS, SYMMETRIC, PairLabel
from lifelore.experiments.chapter2.relation_scoring import JudgedPair, difference, judged_scene, score, share
from lifelore.experiments.chapter2.spoilt_scenes import DISCARDED, WHOLE, key_of
from lifelore.experiments.engine.cell_store import canonical
from lifelore.experiments.engine.estimates import UNMEASURED
from lifelore.perception.pairs.pair_features import PairFeatures
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.relations.relation import Relation
from lifelore.perception.relations.relation_classifier import RelationClassifier

OURS, THESIS, LITERAL = "lifelore", "thesis", "literal"
METHODS = (OURS, THESIS, LITERAL)
KINDS = ("simulated", "real")
Answers = dict[str, dict[str, dict[str, list[JudgedPair]]]]


def scene_of(rows: Sequence[Sequence]) -> ScenePairs:
    """Rows ``[a, b, gap, displacements]`` as the thesis's classifier sees a scene."""
    pairs = np.array([[[a, b], [b, a]] for a, b, *_ in rows], np.int64).reshape(-1, 2)
    gaps = np.repeat([float(gap) for _, _, gap, _ in rows], 2)
    features = PairFeatures((), np.empty((len(pairs), 0)), pairs, gaps)
    return ScenePairs(features, tuple(np.array(moved, float).reshape(-1, 3) for *_, moved in rows))


def labels_of(scene: Mapping) -> list[PairLabel]:
    """The truth of a scene's row."""
    return [PairLabel(*row) for row in scene["truth"]]


def taught(lessons: Sequence[Mapping], reading: str) -> RelationClassifier:
    """The thesis's neighbours among the displacements of the lessons."""
    model = RelationClassifier("displacement", symmetric=SYMMETRIC)
    return model.fit_pairs(
        [scene_of(one["view"][reading]) for one in lessons], [labels_of(one) for one in lessons]
    )


def judged_views(
    scene: Mapping, kind: str, models: Mapping[str, RelationClassifier]
) -> dict[str, dict[str, list]]:
    """By method and view, each labelled pair beside what was said of it."""
    truth = labels_of(scene)
    gaps = {frozenset((a, b)): gap for a, b, gap in scene["gaps"]}
    found: dict[str, dict[str, list]] = {method: {} for method in METHODS}
    for key, view in scene["views"].items():
        for method in METHODS:
            if method in view:
                said = _said(view[method], models.get(method))
                judged = judged_scene(f"{kind} {scene['name']}", truth, said, gaps)
                found[method][key] = [pair for pair in judged if not (kind == "simulated" and pair.border)]
    return found


def _said(rows: Sequence[Sequence], model: RelationClassifier | None) -> tuple[Relation, ...]:
    if model is None:
        return tuple(Relation(a, b, name, 1.0, gap) for a, b, name, gap in rows)
    return model.predict_pairs(scene_of(rows)) if rows else ()


@lru_cache(maxsize=2)
def _answers(results: str) -> Answers:
    """By kind of scenes, method and view; kept, since measures and rows both ask."""
    read = json.loads(results)
    lessons = [scene for result in read if result["kind"] == "lesson" for scene in result["scenes"]]
    models = {reading: taught(lessons, reading) for reading in (THESIS, LITERAL)}
    answers: Answers = {kind: {method: {} for method in METHODS} for kind in KINDS}
    for result in read:
        for scene in result["scenes"] if result["kind"] in KINDS else ():
            for method, views in judged_views(scene, result["kind"], models).items():
                for key, judged in views.items():
                    answers[result["kind"]][method].setdefault(key, []).extend(judged)
    return answers


def _keys(settings: Mapping) -> list[tuple[str, float, str]]:
    return [(way, level, key_of(way, level)) for way, levels in settings["levels"].items() for level in levels]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Of each method exact shares of the whole scenes and what each way of spoiling loses; then the networks."""
    found: dict[str, Estimate] = {}
    for kind, methods in _answers(canonical(list(results))).items():
        for method, views in methods.items():
            scored = score(views.get(WHOLE, []))
            place = f"{method}_{kind}"
            found[f"exact_{place}"] = scored.exact if scored else UNMEASURED
            if scored:
                found[f"macro_f1_{place}"] = scored.macro_f1
                found |= {f"recall_{name}_{place}": recall for name, recall in scored.recall.items()}
            for _, _, key in _keys(settings):
                if key in views or key.startswith(DISCARDED):
                    found[f"lost_{key.replace(' ', '_')}_{place}"] = lost(views, key)
            found[f"less_majority_{place}"] = less_majority(views.get(key_of(DISCARDED, 0.7), []))
        found |= _networks(kind, results)
    return found


def lost(views: Mapping[str, Sequence[JudgedPair]], key: str) -> Estimate:
    """Exact share of the whole scenes less that of the spoilt ones."""
    return difference(views[WHOLE], views[key]) if views.get(WHOLE) and views.get(key) else UNMEASURED


def less_majority(judged: Sequence[JudgedPair]) -> Estimate:
    """Exact share at 70 % discarded less that of always saying the commonest relation (direction known)."""
    if not judged:
        return UNMEASURED
    truths = [pair.truth.relation for pair in judged]
    rate = max(truths.count(name) for name in CORE_RELATIONS) / len(truths)
    exact = share(judged, lambda pair: pair.exact)
    ends = (exact.ci95[0] - rate, exact.ci95[1] - rate) if exact.ci95 else None
    return Estimate(exact.value - rate, exact.median - rate, ends, exact.n)


def _networks(kind: str, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Same number of nodes as in the whole scene, and how far nodes moved (metres), by share discarded."""
    scenes = [scene for result in results if result["kind"] == kind for scene in result["scenes"]]
    found = {}
    for key in scenes[0]["networks"] if scenes else ():
        parts = [scene["networks"][key] for scene in scenes]
        name = f"{key.replace(' ', '_')}_{kind}"
        found[f"same_nodes_{name}"] = _by_scene([part["same"] for part in parts])
        shifts = [shift for part in parts for shift in part["shifts"]]
        middle = float(np.median(shifts)) if shifts else float("nan")
        found[f"median_shift_{name}"] = Estimate(middle, middle, None, len(shifts))
    return found


def _by_scene(answers: Sequence[Sequence[int]]) -> Estimate:
    """Share of yes, scenes resampled."""
    given = [one for one in answers if one]
    if not given:
        return UNMEASURED
    from lifelore.core.metrics import ratio_estimate

    found = ratio_estimate([sum(one) for one in given], [len(one) for one in given])
    return Estimate(found.value, found.median, found.ci95, sum(map(len, given)))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Of each kind, method and view: exact share, macro F1 and recalls."""
    found = []
    for kind, methods in _answers(canonical(list(results))).items():
        for method, views in methods.items():
            for way, level, key in [(WHOLE, 0.0, WHOLE), *_keys(settings)]:
                scored = score(views.get(key, []))
                if scored:
                    recall = {name: round(number.value, 4) for name, number in scored.recall.items()}
                    line = {"scenes": kind, "method": method, "way": way, "level": level, "pairs": scored.pairs}
                    line |= {"exact": scored.exact.to_dict(), "on": scored.on.value, "recall": recall}
                    found.append(line | {"adjacent": scored.adjacent.value, "macro_f1": scored.macro_f1.to_dict()})
    return found
