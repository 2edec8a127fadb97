"""O7: relations named in scenes of unseen shapes, by contacts and by methods that learn from the same scenes.

A round learns from some simulated scenes and is judged on others without a shape in common. An answer is right if
relation and direction are; pairs of objects whose visible gap alone decides the label within 5 mm are left out.
Intervals resample scenes.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.metrics import Estimate, ratio_estimate
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, sample_scene
from lifelore.perception.pairs.scene_pairs import scene_pairs
from lifelore.perception.pairs.side_faces import pairs_beside
from lifelore.perception.reasoning.scene_logic import alternatives, most_likely_scene
from lifelore.perception.relations.relation import Relation
from lifelore.perception.relations.relation_classifier import RelationClassifier, shipped_model
from reproduction.chapter2.scoring.relation_scoring import judged_scene
from reproduction.own.o_07_unseen_scenes.peers import (
    BoundingBoxRule,
    OrientationTrees,
    described,
    pairs_of_objects,
)

OURS, SHIPPED, THESIS, HISTOGRAM, RULE = METHODS = ("contacts", "shipped", "thesis", "histogram", "rule")
PEERS = {HISTOGRAM: OrientationTrees, RULE: BoundingBoxRule}
MODELS: dict[str, Callable[[], Any]] = {
    OURS: RelationClassifier,
    THESIS: lambda: RelationClassifier("displacement"),
    **PEERS,
}
"""Methods that learn in each round; `SHIPPED` has learnt before."""


def cells(settings: Mapping) -> list[dict]:
    """A round each."""
    return [{"round": number} for number in range(settings["rounds"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """By method the pairs answered rightly in each scene, and the pairs asked."""
    lessons, tests = (
        [seen(scene) for scene in _drawn(seed, cell["round"], shapes, settings[name])]
        for name, shapes in (("lessons", "training"), ("tests", "held-out"))
    )
    models: dict[str, Any] = {name: new() for name, new in MODELS.items()}
    for name, model in models.items():
        model.fit([views[name] for _, views in lessons], [scene.truth for scene, _ in lessons])
    models[SHIPPED] = shipped_model()
    counts = {
        name: [counts_of(scene, answers(models[name], views[name], scene)) for scene, views in tests]
        for name in METHODS
    }
    asked = [n for _, n in counts[OURS]]
    return {"asked": asked, "right": {name: [right for right, _ in own] for name, own in counts.items()}}


def _drawn(seed: int, number: int, shapes: str, n: int) -> list[TabletopScene]:
    own = int(stream(seed, "O7", shapes, number).integers(2**31))
    return [sample_scene(own, scene, TabletopSettings(shapes=shapes)) for scene in range(n)]


def seen(scene: TabletopScene) -> tuple[TabletopScene, dict[str, Any]]:
    """A scene, and what each method sees of it."""
    contacts, pairs = scene_pairs(scene.cloud), pairs_of_objects(scene.cloud)
    peers = {name: described(pairs, peer.describe) for name, peer in PEERS.items()}
    return scene, {OURS: contacts, SHIPPED: contacts, THESIS: contacts, **peers}


def answers(model: Any, view: Any, scene: TabletopScene) -> Sequence[Relation]:
    """The relations that a model names; those of our own classifier by contacts are reconciled by scene logic."""
    if not isinstance(model, RelationClassifier) or model.method == "displacement":
        return model.predict(view)
    beliefs = alternatives(model.beliefs(view))
    return most_likely_scene(beliefs, scene.cloud.objects, beside=pairs_beside(view)).relations


def counts_of(scene: TabletopScene, said: Sequence[Relation]) -> tuple[int, int]:
    """Pairs of objects answered rightly, and all of them; without those near the limit of *adjacent*."""
    gaps = {frozenset((gap.a, gap.b)): gap.visible for gap in scene.gaps}
    judged = judged_scene(scene.name, scene.truth, said, gaps)
    exact = [pair.exact for pair in judged if TABLE not in (pair.truth.a, pair.truth.b) and not pair.border]
    return sum(exact), len(exact)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of exact answers by method, and gains of ours on the same pairs."""
    asked = np.array([n for result in results for n in result["asked"]], float)
    some = asked > 0
    right = {
        name: np.array([n for result in results for n in result["right"][name]], float)[some] for name in METHODS
    }
    gains = {f"more_than_{name}": right[OURS] - right[name] for name in (THESIS, HISTOGRAM, RULE)}
    shares = {f"exact_{name}": own for name, own in right.items()}
    return {name: ratio_estimate(own, asked[some]) for name, own in (shares | gains).items()}
