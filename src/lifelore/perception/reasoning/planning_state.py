"""`PlanningState`: the facts of a scene that are sure enough to plan with, and those that stay unknown.

A pair's label is split into what a planner needs: *both* means *on* and *adjacent*, so the probability that a
rests on b is the sum of those of *on* and *both*. The probability of *clear(b)* is that no object rests on b.
Pairs count as independent. A fact of the most likely scene is stated if its probability is at least a threshold;
otherwise it is unknown. *clear(b)* is also unknown if other objects hide a part of b's top from the camera, and
*on(b, table)* where no object carries b and the cloud has no point of a table.

For a planner, a fact that is not stated is false. So each object that may cover another is named: it may rest on
it, or it hides the top. A plan takes it away first, whether or not it does rest there.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import prod
from types import MappingProxyType

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, BOTH, CORE_RELATIONS, ON
from lifelore.perception.reasoning.fact import Fact, objects_without_support
from lifelore.perception.reasoning.hidden_tops import hidden_tops
from lifelore.perception.reasoning.label_distribution import LabelDistribution, label_distributions
from lifelore.perception.reasoning.scene_logic import alternatives
from lifelore.perception.relations.relation import Relation
from lifelore.perception.scene import Scene

CLEAR = "clear"
PLAN_CONFIDENCE = 0.6
"""Default threshold of planning problems: a higher value gives fewer plans, of which more are valid."""
DOUBTFUL, HIDDEN, NO_TABLE = "doubtful", "hidden", "no table"
"""Reasons why a fact is unknown: its probability is below the threshold, the place is out of sight, or the cloud
has no table."""
NO_HIDDEN: Mapping[int, Collection[int]] = MappingProxyType({})


@dataclass(frozen=True, order=True)
class UnknownFact:
    """A fact of the most likely scene that is not stated, its probability in [0, 1], and the reason.

    Examples
    --------
    >>> str(UnknownFact(Fact("clear", (3,)), 0.75, HIDDEN))
    'clear(3), probability 0.75, hidden'
    """

    fact: Fact
    probability: float
    reason: str

    def __str__(self) -> str:
        return f"{self.fact}, probability {self.probability:.2f}, {self.reason}"


@dataclass(frozen=True)
class PlanningState:
    """The objects of a scene, and its facts to plan with.

    Parameters
    ----------
    objects : tuple of int
        Ascending.
    stated : tuple of Fact
        ``on(a, b)``, ``on(a, table)``, ``adjacent(a, b)`` with a < b, ``clear(a)``, and words of a user; sorted.
    unknown : tuple of UnknownFact
        Sorted.
    may_cover : mapping of (int, int) to str
        Pairs (a, b), sorted, with the reason: a may rest on b, though that is not stated (`DOUBTFUL`), or a hides
        a part of b's top (`HIDDEN`).
    probability : mapping of Fact to float
        Of every fact of the most likely scene, stated or not. That of ``clear(a)``, which every object has, is the
        probability that nothing rests on a beside what is stated and what may cover it, as far as the camera sees.
    """

    objects: tuple[int, ...]
    stated: tuple[Fact, ...]
    unknown: tuple[UnknownFact, ...] = ()
    may_cover: Mapping[tuple[int, int], str] = field(default_factory=dict)
    probability: Mapping[Fact, float] = field(default_factory=dict, compare=False)


def scene_state(scene: Scene, least: float = 0.0) -> PlanningState:
    """The state of a perceived scene at a threshold in [0, 1]; hidden tops are unknown at any threshold.

    What no object carries in a scene without a table is unknown to be on the table. The probability of that fact
    is that no object carries it.

    Raises
    ------
    InputError
        The threshold is outside [0, 1].
    """
    distributions = label_distributions(alternatives(scene.beliefs)) if scene.beliefs else None
    state = planning_state(scene.relations, scene.objects, least, distributions, hidden_tops(scene.cloud))
    if scene.cloud.has_table:
        return state
    known = label_distributions(scene.relations) if distributions is None else distributions
    unknown = {
        UnknownFact(Fact(ON, (x, TABLE)), prod(1 - one.carried(x) for one in known if x in one.pair), NO_TABLE)
        for x in objects_without_support(scene.relations, scene.objects)
    }
    return replace(state, unknown=tuple(sorted(unknown.union(state.unknown))))


def planning_state(
    relations: Iterable[Relation],
    objects: Iterable[int] = (),
    least: float = 0.0,
    distributions: Sequence[LabelDistribution] | None = None,
    hidden: Mapping[int, Collection[int]] = NO_HIDDEN,
) -> PlanningState:
    """The state that relations give.

    Parameters
    ----------
    relations : iterable of Relation
        The most likely scene, and words of a user, whose confidence is their probability.
    objects : iterable of int
        Objects beside those the relations name.
    least : float
        Least probability of a stated fact, in [0, 1]; at 0 all are stated.
    distributions : sequence of LabelDistribution, optional
        Probabilities of all labels of each near pair; default: from the confidences of the relations.
    hidden : mapping of int to collection of int
        Objects whose top is partly hidden, each with those that hide it.

    Raises
    ------
    InputError
        The threshold is outside [0, 1].
    """
    if not 0 <= least <= 1:
        raise InputError(f"min_confidence must be a probability from 0 to 1, got {least!r}")
    relations = tuple(relations)
    things = tuple(sorted({*objects, *(end for r in relations for end in (r.a, r.b))} - {TABLE}))
    known = label_distributions(relations) if distributions is None else distributions
    by_pair = {frozenset(one.pair): one for one in known}
    likely = _likely_facts(relations, by_pair)
    stated = {fact for fact, probability in likely.items() if probability >= least}
    unknown = {UnknownFact(fact, likely[fact], DOUBTFUL) for fact in set(likely) - stated}
    may_cover: dict[tuple[int, int], str] = {}
    clear: dict[Fact, float] = {}
    for thing in things:
        on_it = {fact.arguments[0] for fact in likely if fact.name == ON and fact.arguments[1] == thing}
        stated_on_it = {a for a in on_it if Fact(ON, (a, thing)) in stated}
        carried = {x: one.carried(x) for one in known for x in _others(one, thing) if x not in stated_on_it}
        doubted = _doubted(carried, on_it - stated_on_it, least)
        unseen = () if on_it else hidden.get(thing, ())
        may_cover |= {(x, thing): DOUBTFUL for x in doubted} | {(x, thing): HIDDEN for x in unseen}
        clear[Fact(CLEAR, (thing,))] = prod(1 - p for x, p in carried.items() if x not in doubted)
        if not on_it and (doubted or unseen):
            free = prod(1 - p for p in carried.values())
            unknown.add(UnknownFact(Fact(CLEAR, (thing,)), free, HIDDEN if unseen else DOUBTFUL))
        elif not on_it:
            stated.add(Fact(CLEAR, (thing,)))
    covers = dict(sorted(may_cover.items()))
    return PlanningState(things, tuple(sorted(stated)), tuple(sorted(unknown)), covers, likely | clear)


def _doubted(carried: Mapping[int, float], unstated: Collection[int], least: float) -> set[int]:
    """The objects that may rest on another one, so that no other does with a probability of at least `least`.

    They are the `unstated` ones, which rest on it in the most likely scene, and of the others the likeliest, as
    many as it takes. `carried` has the probability of each object whose resting there is not stated.
    """
    doubted = set(unstated)
    others = sorted(carried.keys() - doubted, key=lambda x: (carried[x], -x))
    while others and prod(1 - carried[x] for x in others) < least:
        doubted.add(others.pop())
    return doubted


def _others(one: LabelDistribution, thing: int) -> list[int]:
    """The other object of a pair that this object is part of; none for the table and other pairs."""
    return [x for x in one.pair if x not in (thing, TABLE)] if thing in one.pair else []


def _likely_facts(
    relations: Iterable[Relation], by_pair: dict[frozenset[int], LabelDistribution]
) -> dict[Fact, float]:
    """*on*, *adjacent* and words of the most likely scene with their probabilities."""
    likely: dict[Fact, float] = {}
    for r in relations:
        one = by_pair.get(frozenset((r.a, r.b)))
        if r.relation in (ON, BOTH):
            likely[Fact(ON, (r.a, r.b))] = r.confidence if one is None else one.carried(r.a)
        if r.relation in (ADJACENT, BOTH) and TABLE not in (r.a, r.b):
            fact = Fact(ADJACENT, (min(r.a, r.b), max(r.a, r.b)))
            likely[fact] = r.confidence if one is None else one.beside
        if r.relation not in CORE_RELATIONS:
            likely[Fact(r.relation, (r.a, r.b))] = r.confidence
    return likely
