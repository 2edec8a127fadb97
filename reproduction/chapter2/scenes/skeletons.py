"""Skeletons of perceived scenes: the contacts of all near pairs, or of related pairs.

Perception gives every near pair contact points, also pairs whose relation is then *none* (a stack's top and the
table far below it). The thesis's pictures show no such contacts, and no table: its background is taken off before
(§2.3.2), so the ground's contacts take part only where `ground` is set.
"""

from functools import cache

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import ADJACENT, BOTH, NONE, ON, PairLabel
from lifelore.perception.relations.relation_classifier import shipped_model
from lifelore.perception.scene import Scene
from lifelore.perception.scene_perception import perceived_scene

RELATED = (ON, BOTH, ADJACENT)
_model = cache(shipped_model)


def perceived(cloud: LabelledCloud) -> Scene:
    """The scene as `lifelore perceive` sees it, with the model that ships with the package."""
    return perceived_scene(cloud, _model())


def reading(scene: Scene, *, ground: bool = False) -> Scene:
    """The same scene with only the contacts of pairs whose predicate is among `RELATED`.

    The table's contacts take part only where `ground` is set.
    """
    relation = {frozenset((r.a, r.b)): r.relation for r in scene.relations}

    def kept(a: int, b: int) -> bool:
        return (ground or TABLE not in (a, b)) and relation.get(frozenset((a, b)), NONE) in RELATED

    contacts = tuple(pair for pair in scene.interfaces if kept(pair.a, pair.b))
    return Scene(scene.cloud, contacts, tuple(r for r in scene.relations if kept(r.a, r.b)))


def predicates(scene: Scene) -> set[tuple[str, int, int]]:
    """``(relation, a, b)`` of every pair whose perceived relation is not *none*."""
    return {(r.relation, r.a, r.b) for r in scene.relations if r.relation != NONE}


def carried_pairs(truth: tuple[PairLabel, ...]) -> set[tuple[int, int]]:
    """(upper, lower) of all objects on objects whose labels are not in doubt."""
    return {(t.a, t.b) for t in truth if t.relation == ON and t.b != TABLE and t.confidence >= 2}


def standing(truth: tuple[PairLabel, ...]) -> set[int]:
    """Labels of objects on the table."""
    return {label.a for label in truth if label.relation == ON and label.b == TABLE}
