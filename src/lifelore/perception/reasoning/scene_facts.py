"""Every fact of a scene in one list: relations, compound and geometric ones, and the region calculus."""

from lifelore.core.relations import NONE
from lifelore.perception.reasoning.compound_relations import compound_relations
from lifelore.perception.reasoning.fact import Fact, objects_without_support, words_outside_core
from lifelore.perception.reasoning.geometric_relations import geometric_relations
from lifelore.perception.reasoning.region_calculus import region_relations
from lifelore.perception.scene import Scene


def scene_facts(scene: Scene) -> tuple[Fact, ...]:
    """The facts of a scene, sorted by name and objects, each once; *none* is not a fact.

    Of words outside the core vocabulary, and where nothing says what an object rests on, the facts are the
    relations themselves: *clear* or *disconnected* would be guesses (see `core_words`).
    """
    stated = {Fact(r.relation, (r.a, r.b)) for r in scene.relations if r.relation != NONE}
    if words_outside_core(scene.relations) or objects_without_support(scene.relations, scene.objects):
        return tuple(sorted(stated))
    derived = compound_relations(scene.relations, scene.objects)
    regions = region_relations(scene.relations, scene.objects)
    return tuple(sorted({*stated, *derived, *geometric_relations(scene), *regions}))
