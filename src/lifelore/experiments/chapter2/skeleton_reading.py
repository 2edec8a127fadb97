"""Which contacts a scene's skeleton is made of: of all near pairs, of related pairs, or of those that support.

Perception gives every near pair contact points, also pairs of which it then says *none* (a stack's top and the
table far below it). The thesis's pictures show no such contacts, and no table: its background is taken off before
(§2.3.2), so the ground's contacts take part only where that is asked for.
"""

from collections.abc import Collection
from functools import cache

import numpy as np

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import ADJACENT, BOTH, NONE, ON
from lifelore.perception.perceived_scene import perceived_scene
from lifelore.perception.relations.relation_classifier import RelationClassifier, shipped_model
from lifelore.perception.scene import Scene

NEAR = (ON, BOTH, ADJACENT, NONE)
RELATED = (ON, BOTH, ADJACENT)
SUPPORT = (ON, BOTH)


@cache
def _model() -> RelationClassifier:
    return shipped_model()


def perceived(cloud: LabelledCloud) -> Scene:
    """The scene as `lifelore perceive` sees it, with the model that ships with the package."""
    return perceived_scene(cloud, _model())


def reading(scene: Scene, words: Collection[str] = RELATED, *, ground: bool = False) -> Scene:
    """The same scene with the contacts alone of pairs whose predicate is among `words`.

    Parameters
    ----------
    scene : Scene
    words : collection of str
        `NEAR`, `RELATED`, `SUPPORT`, or any other predicates.
    ground : bool
        Whether the table's contacts take part.
    """
    said = {frozenset((r.a, r.b)): r.relation for r in scene.relations}

    def kept(a: int, b: int) -> bool:
        return (ground or TABLE not in (a, b)) and said.get(frozenset((a, b)), NONE) in words

    contacts = tuple(one for one in scene.interfaces if kept(one.a, one.b))
    # Whoever reads a scene may leave out what its relations call strangers: of all near pairs nothing is said.
    relations = () if NONE in words else tuple(r for r in scene.relations if kept(r.a, r.b))
    return Scene(scene.cloud, contacts, relations)


def only(cloud: LabelledCloud, objects: Collection[int]) -> LabelledCloud:
    """The cloud of some objects and the table."""
    kept = np.isin(cloud.labels, [TABLE, *objects])
    colours = None if cloud.colours is None else cloud.colours[kept]
    return LabelledCloud(cloud.points[kept], cloud.labels[kept], colours, cloud.camera)


def predicates(scene: Scene) -> set[tuple[str, int, int]]:
    """``(relation, a, b)`` of every pair of which perception says more than *none*."""
    return {(r.relation, r.a, r.b) for r in scene.relations if r.relation != NONE}
