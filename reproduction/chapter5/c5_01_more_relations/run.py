"""Cells of claim C5.1: scenes to learn words of space from, held-out scenes from two sides, compound relations.

Cells of *lessons* and of held-out scenes store the features of every near pair and all its true words by
`view_words`; held-out scenes also as a camera on the other side of the table sees them. Cells of *compound* scenes
store the facts of the thesis's `between` and `in`, and of our own definitions, for purposely arranged scenes.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations, permutations

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import ADJACENT, BOTH, PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.depth_camera import CAMERAS
from lifelore.domains.tabletop.layout import Group, put_beside, stand
from lifelore.domains.tabletop.photograph import FIRST_OBJECT, photograph
from lifelore.domains.tabletop.physics import Tabletop
from lifelore.domains.tabletop.pose import about
from lifelore.domains.tabletop.shapes import ball, box, cup
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, sample_scene
from lifelore.perception.contacts.interface import interfaces
from lifelore.perception.pairs.pair_features import pair_features
from lifelore.perception.perceived_scene import perceived_scene
from lifelore.perception.reasoning.compound_relations import compound_relations
from lifelore.perception.reasoning.geometric_relations import geometric_relations
from lifelore.perception.relations.relation import Relation
from lifelore.perception.relations.relation_classifier import shipped_model
from reproduction.chapter2.scenes.arranged_scenes import Placement, arranged, settled, turned
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of
from reproduction.chapter2.scenes.skeletons import shipped_model_digest
from reproduction.chapter2.scenes.tabletop_pairs import without_table
from reproduction.chapter5.c5_01_more_relations.view_words import Points, is_between, is_in, words_of_pair

LOT = {"lesson": 8, "held-out": 8, "compound": 10}
LESSON, HELD_OUT, COMPOUND = LOT
DIGITS = 5
BY_POINTS = {"enclosed_between": "between", "contained": "in"}
"""Names of `geometric_relations` → the thesis's."""
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


def _sizes(settings: Mapping) -> dict[str, int]:
    return {LESSON: max(settings["lessons"]), HELD_OUT: settings["scenes"], COMPOUND: settings["compound"]}


def cells(settings: Mapping) -> list[dict]:
    """Lots of lessons, of held-out scenes, and of each kind of compound scenes."""
    of_kinds = [{"of": kind, "model": shipped_model_digest()} for kind in KINDS]
    heads = {LESSON: [{}], HELD_OUT: [{}], COMPOUND: of_kinds}
    return [
        lot
        for kind, n in _sizes(settings).items()
        for head in heads[kind]
        for lot in lots(n, LOT[kind], kind=kind, **head)
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """``{"kind", "of", "scenes": […]}``."""
    kind, of = cell["kind"], cell.get("of", "")
    scenes = []
    for number in numbers_of(cell, LOT[kind], _sizes(settings)[kind]):
        if kind == COMPOUND:
            scenes.append(compound_facts(compound_scene(of, seed, number)))
        else:
            scene = _drawn(seed, "training" if kind == LESSON else HELD_OUT, number)
            scenes.append(seen(scene, scene.cloud))
            if kind == HELD_OUT:
                behind = from_the_other_side(scene, stream(seed, "word scenes", "other side", number))
                scenes[-1]["other_side"] = seen(scene, behind) if behind is not None else None
    return {"kind": kind, "of": of, "scenes": scenes}


def _drawn(seed: int, shapes: str, number: int) -> TabletopScene:
    own = int(stream(seed, "word scenes", shapes).integers(2**31))
    return sample_scene(own, number, TabletopSettings(shapes=shapes))


def outlines(scene: TabletopScene) -> dict[int, Points]:
    """Points that span each object, by label."""
    placed = zip(scene.shapes, scene.poses, strict=True)
    return {FIRST_OBJECT + k: pose.apply(shape.outline()) for k, (shape, pose) in enumerate(placed)}


def from_the_other_side(scene: TabletopScene, rng: np.random.Generator) -> LabelledCloud | None:
    """The same objects from a camera carried half round the table; None where it does not see all of them."""
    spans = list(outlines(scene).values())
    every = np.concatenate(spans)
    middle = np.append((every.min(axis=0) + every.max(axis=0))[:2] / 2, 0.0)
    view = scene.view.moved(-middle).turned(np.pi).moved(middle)
    photo = photograph(Tabletop(scene.shapes, scene.poses), spans, view, CAMERAS["kinect"], rng)
    return None if photo is None else photo.cloud


def seen(scene: TabletopScene, cloud: LabelledCloud) -> dict:
    """Features of the near pairs; words true of all labelled pairs; words by the visible points alone."""
    bare = without_table(cloud)
    features = pair_features(bare, interfaces(bare))
    pairs = [(min(t.a, t.b), max(t.a, t.b)) for t in scene.truth if TABLE not in (t.a, t.b)]

    def words(points: Mapping[int, Points]) -> list[list]:
        assert cloud.camera is not None
        labels = [label for a, b in pairs for label in words_of_pair(a, b, points[a], points[b], cloud.camera)]
        return [[label.a, label.b, label.relation] for label in labels]

    return {
        "pairs": features.pairs.tolist(),
        "gaps": np.round(features.gaps, DIGITS).tolist(),
        "features": np.round(features.matrix, DIGITS).tolist(),
        "labelled": pairs,
        "truth": words(outlines(scene)),
        "by_rule": words({label: bare.of(label) for label in bare.objects}),
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
    """The facts ``[word, objects…]`` that are true by geometry, and those that each way finds.

    *thesis*: its rules on true relations; *thesis_perceived*: on perceived ones; *lifelore*: `geometric_relations`
    of the perceived scene.
    """
    perceived = perceived_scene(scene.cloud, shipped_model())

    def by_rules(relations: Iterable[Relation]) -> Facts:
        facts = compound_relations(tuple(relations), scene.cloud.objects)
        return {(fact.name, fact.arguments) for fact in facts if fact.name in BY_POINTS.values()}

    ways = {
        "true": true_compounds(scene),
        "thesis": by_rules(Relation(t.a, t.b, t.relation, 1.0, 0.0) for t in scene.truth),
        "thesis_perceived": by_rules(perceived.relations),
        "lifelore": {(BY_POINTS[fact.name], fact.arguments) for fact in geometric_relations(perceived)},
    }
    return {way: sorted([word, *objects] for word, objects in facts) for way, facts in ways.items()}


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


def labels_of(rows: Sequence[Sequence]) -> list[PairLabel]:
    """Rows ``[a, b, word]`` as labels."""
    return [PairLabel(int(a), int(b), str(word)) for a, b, word in rows]


def check(settings: Mapping) -> None:
    if sorted(settings["lessons"]) != list(settings["lessons"]):
        raise InputError(f"lessons must rise, got {settings['lessons']}")
