"""Relations made of relations: clear, stacked, supports*, and the thesis's `between` and `in`.

| fact | holds when |
|---|---|
| ``clear(a)`` | no object rests on a; with other words only where *on* or *both* supports every object |
| ``supports*(a, b)`` | b rests on a, directly or through others; a is an object |
| ``stacked(a, b, c)`` | a rests on b, b on c, three objects (Fig. 2.7) |
| ``between(b, a, c)`` | b is adjacent to a and to c, a before c (§5.2: "two different adjacent relationships") |
| ``in(a, b)`` | a is on b and adjacent to it (§5.2: "the presence of on as well as adjacent") |

"Rests on" is *on* or *both*. The last two are as the thesis proposes and are not what the words mean: see errata
E14, and `geometric_relations` for definitions that look at the points.

Thesis: §5.2.
"""

from collections.abc import Iterable

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, BOTH, ON
from lifelore.perception.reasoning.fact import Fact, objects_without_support, words_outside_core
from lifelore.perception.reasoning.scene_logic import reached_from
from lifelore.perception.relations.relation import Relation


def compound_relations(relations: Iterable[Relation], objects: Iterable[int] = ()) -> tuple[Fact, ...]:
    """Every compound fact that the relations imply, sorted by name and objects.

    Parameters
    ----------
    relations : iterable of Relation
        Of any vocabulary. With a word outside the core vocabulary, and an object that no *on* or *both* supports,
        no object is said to be clear: that word may mean resting.
    objects : iterable of int
        Objects beside those the relations name.

    Examples
    --------
    >>> row = [Relation(2, 3, "adjacent", 1.0, 0.0), Relation(3, 4, "adjacent", 1.0, 0.0)]
    >>> [str(fact) for fact in compound_relations(row) if fact.name != "clear"]
    ['between(3, 2, 4)']
    """
    relations = tuple(relations)
    things = {*objects, *(label for r in relations for label in (r.a, r.b))} - {TABLE}
    on = {(r.a, r.b) for r in relations if r.relation in (ON, BOTH)}
    neighbours = [(r.a, r.b) for r in relations if r.relation in (ADJACENT, BOTH)]
    beside = {pair for a, b in neighbours for pair in ((a, b), (b, a))}
    carries: dict[int, set[int]] = {}
    for upper, lower in on:
        if lower != TABLE:
            carries.setdefault(lower, set()).add(upper)
    facts = {Fact("supports*", (a, b)) for a in carries for b in reached_from(a, carries) if a != b}
    facts |= {
        Fact("stacked", (a, b, c)) for c in carries for b in carries[c] for a in carries.get(b, ()) if a != c
    }
    facts |= {
        Fact("between", (b, a, c))
        for a, b in beside
        for other, c in beside
        if other == b and a < c and TABLE not in (a, b, c)
    }
    facts |= {Fact("in", (a, b)) for a, b in on & beside if b != TABLE}
    if not (words_outside_core(relations) and objects_without_support(relations, things)):
        facts |= {Fact("clear", (thing,)) for thing in things if thing not in carries}
    return tuple(sorted(facts))
