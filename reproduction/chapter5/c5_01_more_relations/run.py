"""C5.1: words of space learnt from labelled scenes, and the thesis's rules for `between` and `in`.

A classifier learns the words of `view_words` from simulated scenes and predicts them for scenes of other shapes.
The rules are applied to true relations, so that nothing but the rules is judged, in usual scenes and in scenes
that show a compound relation or a counterexample. Intervals resample scenes. Thesis: §2.4.1, §5.2.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations, permutations

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.metrics import Estimate
from lifelore.core.relations import ADJACENT, BOTH, PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.layout import Group, put_beside, stand
from lifelore.domains.tabletop.photograph import FIRST_OBJECT
from lifelore.domains.tabletop.pose import about
from lifelore.domains.tabletop.shapes import ball, box, cup
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, sample_scene
from lifelore.perception.contacts.interface import interfaces
from lifelore.perception.pairs.pair_features import pair_features
from lifelore.perception.pairs.scene_pairs import ScenePairs
from lifelore.perception.reasoning.compound_relations import compound_relations
from lifelore.perception.relations.relation import Relation
from lifelore.perception.relations.relation_classifier import RelationClassifier
from reproduction.chapter2.scenes.arranged_scenes import Placement, arranged, settled, turned
from reproduction.chapter2.scenes.perturbation import part_of
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of
from reproduction.chapter5.c5_01_more_relations.view_words import (
    USER_WORD,
    WORDS,
    Points,
    is_between,
    is_in,
    words_of_pair,
)
from reproduction.engine.estimates import ratio_or_unmeasured

LOT = 10
HELD_OUT = "held-out"
COMPOUNDS = ("between", "in")
Facts = set[tuple[str, tuple[int, ...]]]


def place_angle(rng: np.random.Generator) -> Group:
    """A block and two neighbours at a right angle: it is adjacent to both, and not between them."""
    blocks = [stand(box(*rng.uniform(0.06, 0.1, 3)), about(2, rng.normal(0, 0.05))) for _ in range(3)]
    gaps = rng.uniform(0.0005, 0.012, 2)
    group = blocks[:1]
    for block, direction, gap in zip(blocks[1:], (0.0, np.pi / 2), gaps, strict=True):
        group = [*group, *put_beside(blocks[:1], [block], direction, float(gap))]
    return turned(rng, group)


def place_in_cup(rng: np.random.Generator) -> Group:
    """A ball in a wide cup."""
    radius, wall = float(rng.uniform(0.022, 0.03)), 0.005
    wide = radius + wall + float(rng.uniform(0.004, 0.02))
    vessel = stand(cup(0.9 * wide, 1.15 * wide, float(rng.uniform(0.9, 1.5)) * radius, wall, handle=False))
    shift = rng.uniform(-0.3, 0.3, 2) * (wide - wall - radius)
    return [vessel, stand(ball(radius), height=wall + 0.002).moved(*map(float, shift))]


OURS = {
    "angle": Placement(place_angle, frozenset({(2, 3, ADJACENT), (2, 4, ADJACENT)})),
    "cup": Placement(place_in_cup),
}
KINDS = ("mixed", "row", "angle", "cup", "corner", "leaning")
"""Of compound scenes: *row* shows between, *angle* does not; *cup* shows in, *corner* and *leaning* do not."""


def cells(settings: Mapping) -> list[dict]:
    """The lesson in words, and each kind of compound scenes in lots."""
    compound = [lot for kind in KINDS for lot in lots(settings["compound"], LOT, kind=kind)]
    return [{"kind": "lesson"}, *compound]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Of the lesson the counts of each word in held-out scenes; of compound scenes their facts."""
    if cell["kind"] == "lesson":
        lessons, tests = (
            [seen(_drawn(seed, shapes, number)) for number in range(settings[name])]
            for name, shapes in (("lessons", "training"), ("scenes", HELD_OUT))
        )
        scenes, truths = map(list, zip(*lessons, strict=True))
        model = RelationClassifier(multi_label=True).fit(scenes, truths)
        return {
            "kind": "lesson",
            "counts": [word_counts(words, predicted(model, pairs)) for pairs, words in tests],
        }
    numbers = numbers_of(cell, LOT, settings["compound"])
    return {
        "kind": cell["kind"],
        "scenes": [compound_facts(compound_scene(cell["kind"], seed, n)) for n in numbers],
    }


def _drawn(seed: int, shapes: str, number: int) -> TabletopScene:
    own = int(stream(seed, "word scenes", shapes).integers(2**31))
    return sample_scene(own, number, TabletopSettings(shapes=shapes))


def outlines(scene: TabletopScene) -> dict[int, Points]:
    """Points that span each object, by label."""
    placed = zip(scene.shapes, scene.poses, strict=True)
    return {FIRST_OBJECT + k: pose.apply(shape.outline()) for k, (shape, pose) in enumerate(placed)}


def seen(scene: TabletopScene) -> tuple[ScenePairs, list[PairLabel]]:
    """The near pairs of objects as the classifier sees them, and the words that are true; not its many points."""
    bare = part_of(scene.cloud, scene.cloud.labels > TABLE)
    return ScenePairs(pair_features(bare, interfaces(bare)), ()), true_words(scene)


def true_words(scene: TabletopScene) -> list[PairLabel]:
    """The words that are true of the labelled pairs of objects, by the true shapes."""
    spans = outlines(scene)
    pairs = [(min(t.a, t.b), max(t.a, t.b)) for t in scene.truth if TABLE not in (t.a, t.b)]
    assert scene.cloud.camera is not None
    return [label for a, b in pairs for label in words_of_pair(a, b, spans[a], spans[b], scene.cloud.camera)]


def predicted(model: RelationClassifier, pairs: ScenePairs) -> set[tuple[int, int, str]]:
    """The words that the model predicts for a scene; symmetric words in both orders."""
    relations = model.predict(pairs) if len(pairs.features.pairs) else ()
    found = {(r.a, r.b, r.relation) for r in relations}
    return found | {(r.b, r.a, r.relation) for r in relations if r.relation in model.symmetric_}


def word_counts(truth: Sequence[PairLabel], said: set[tuple[int, int, str]]) -> dict[str, list[int]]:
    """By word the ordered labelled pairs of a scene with the word rightly predicted, predicted and true."""
    true = {(label.a, label.b, label.relation) for label in truth}
    orders = {order for a, b, _ in true for order in ((a, b), (b, a))}
    asked = {fact for fact in said if fact[:2] in orders}
    return {
        word: [sum(fact[2] == word for fact in facts) for facts in (true & asked, asked, true)] for word in WORDS
    }


def compound_scene(kind: str, seed: int, number: int) -> TabletopScene:
    """Scene `number` of a kind."""
    if kind == "mixed":
        return _drawn(seed, HELD_OUT, number)
    if kind == "leaning":
        own = int(stream(seed, "word scenes", kind).integers(2**31))
        return sample_scene(own, number, TabletopSettings(arrangement="pair", mix={BOTH: 1.0}, shapes="all"))
    return settled(OURS[kind], kind, seed, number) if kind in OURS else arranged(kind, seed, number)


def compound_facts(scene: TabletopScene) -> dict[str, list]:
    """The facts ``[word, objects…]`` that are true by geometry, and those of the rules on true relations."""
    relations = tuple(Relation(t.a, t.b, t.relation, 1.0, 0.0) for t in scene.truth)
    by_rule = {
        (f.name, f.arguments) for f in compound_relations(relations, scene.cloud.objects) if f.name in COMPOUNDS
    }
    facts = {"true": true_compounds(scene), "rule": by_rule}
    return {way: sorted([word, *objects] for word, objects in found) for way, found in facts.items()}


def true_compounds(scene: TabletopScene) -> Facts:
    """`between` (b, a, c) with a < c, and `in` (a, b), of the true shapes."""
    spans = outlines(scene)
    parts = {
        FIRST_OBJECT + k: [pose.apply(part.outline()) for part in shape.parts]
        for k, (shape, pose) in enumerate(zip(scene.shapes, scene.poses, strict=True))
    }
    near = {pair for t in scene.truth for pair in ((t.a, t.b), (t.b, t.a))}
    between = {
        ("between", (b, a, c))
        for b in spans
        for a, c in combinations(sorted(other for other in spans if (other, b) in near), 2)
        if is_between(spans[b], spans[a], spans[c])
    }
    inside = {("in", (a, b)) for a, b in permutations(spans, 2) if (a, b) in near and is_in(spans[a], parts[b])}
    return between | inside


def compound_counts(results: Sequence[Mapping], word: str) -> NDArray[np.float64]:
    """Of each compound scene: facts rightly found by the rule, found, true, ``(n, 3)``."""
    counts = []
    for result in results:
        for scene in result["scenes"] if result["kind"] in KINDS else ():
            found, true = ({tuple(fact) for fact in scene[key] if fact[0] == word} for key in ("rule", "true"))
            counts.append((len(found & true), len(found), len(true)))
    return np.array(counts, float).reshape(-1, 3)


def f1(counts: NDArray[np.float64]) -> Estimate:
    """2 right / (predicted + true)."""
    return ratio_or_unmeasured(2 * counts[:, 0], counts[:, 1] + counts[:, 2])


def learnt(results: Sequence[Mapping]) -> dict[str, Estimate]:
    """F1 of each word in held-out scenes, after all lessons."""
    counts = next(result["counts"] for result in results if result["kind"] == "lesson")
    return {word: f1(np.array([scene[word] for scene in counts], float)) for word in WORDS}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """F1 of the user's word and least F1 of the five; precision and recall of the rules."""
    words = learnt(results)
    found = {f"f1_{USER_WORD}": words.pop(USER_WORD)}
    found["least_f1_of_the_five"] = min(words.values(), key=lambda score: score.value if score.n else 2.0)
    for word in COMPOUNDS:
        right, said, true = compound_counts(results, word).T
        found |= {
            f"precision_{word}": ratio_or_unmeasured(right, said),
            f"recall_{word}": ratio_or_unmeasured(right, true),
        }
    return found
