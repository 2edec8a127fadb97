"""Every fact of a scene in one list: relations, compound and geometric ones, and the region calculus."""

from dataclasses import replace

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, NONE, ON
from lifelore.perception.reasoning.compound_relations import compound_relations
from lifelore.perception.reasoning.fact import Fact, objects_without_support
from lifelore.perception.reasoning.geometric_relations import geometric_relations
from lifelore.perception.reasoning.planning_state import CLEAR, PlanningState
from lifelore.perception.reasoning.region_calculus import DISCONNECTED, region_relations
from lifelore.perception.relations.relation import Relation
from lifelore.perception.scene import Scene


def scene_facts(scene: Scene) -> tuple[Fact, ...]:
    """The facts of a scene, sorted by name and objects, each once; *none* is not a fact.

    Where no relation says what an object rests on, the facts are the relations themselves: *clear* or
    *disconnected* would be guesses (see `fact`). In a scene without a table, where such objects are usual, only
    facts that name the table are left out.
    """
    if scene.cloud.has_table and objects_without_support(scene.relations, scene.objects):
        return tuple(sorted(_relations_as_facts(scene)))
    return tuple(sorted(_relations_as_facts(scene) | _derived(scene)))


def sure_facts(scene: Scene, state: PlanningState, least: float) -> tuple[Fact, ...]:
    """The facts of `scene_facts` that follow from relations with a confidence of at least `least` alone.

    *clear* holds where `state`, the scene's at the same threshold, states it. A doubtful *both* still counts as
    *on* or *adjacent* where the state has these.
    """
    facts = set(scene_facts(scene))
    if least > 0:
        sure = tuple(r for r in scene.relations if r.confidence >= least)
        pairs = [(*f.arguments, f.name) for f in state.stated if f.name in (ON, ADJACENT)]
        parts = [Relation(a, b, name, least, 0.0) for a, b, name in pairs]
        alone = replace(scene, relations=(*sure, *parts))
        facts &= _relations_as_facts(alone) | _derived(alone)
        doubted = {frozenset((r.a, r.b)) for r in scene.relations if r.confidence < least}
        facts = {f for f in facts if f.name != DISCONNECTED or frozenset(f.arguments) not in doubted}
    return tuple(sorted(fact for fact in facts if fact.name != CLEAR or fact in state.stated))


def _relations_as_facts(scene: Scene) -> set[Fact]:
    return {Fact(r.relation, (r.a, r.b)) for r in scene.relations if r.relation != NONE}


def _derived(scene: Scene) -> set[Fact]:
    derived = compound_relations(scene.relations, scene.objects)
    regions = region_relations(scene.relations, scene.objects)
    found = {*derived, *geometric_relations(scene), *regions}
    return {fact for fact in found if scene.cloud.has_table or TABLE not in fact.arguments}
